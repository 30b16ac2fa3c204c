// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "import/import_mesh.h"
#include "material/material_settings.h"
#include "material/surface_share.h"

namespace kiln {

/// Opacity of a mesh's surface: where it is below a cutoff, which each material has, nothing is there, as engines and
/// glTF have it for leaves and fences (alpha mode MASK). Copies share large data. May be used by several threads at
/// once.
class SurfaceOpacity {
 public:
  /// Makes a surface that is opaque everywhere.
  SurfaceOpacity() = default;

  /// `cutoffs` are those of the share's materials, each above 0 and below 1.
  SurfaceOpacity(SurfaceShare share, std::vector<float> cutoffs)
      : share_(std::move(share)), cutoffs_(std::move(cutoffs)) {}

  bool is_opaque() const { return cutoffs_.empty(); }

  /// Returns the opacity at a point of a triangle, stretched on either side of the material's cutoff so that this is
  /// 0.5 everywhere; u is the weight of the second corner, v that of the third.
  float at(std::uint32_t triangle, float u, float v) const;

  /// Tells whether a triangle is of a material that opacity cuts: of a sheet such as a leaf, which encloses nothing.
  bool is_sheet(std::uint32_t triangle) const;

  /// Returns the share that is there of a surface that is not opaque, and the cutoff of one of its materials.
  const SurfaceShare& share() const { return share_; }
  float cutoff(std::uint32_t material) const { return cutoffs_[material]; }

 private:
  SurfaceShare share_;
  std::vector<float> cutoffs_;
};

struct LoadedOpacity {
  SurfaceOpacity opacity;
  std::vector<std::filesystem::path> files;  ///< pictures that were read
  std::vector<std::string> warnings;         ///< sentences without a full stop
};

/// Loads the opacity of a mesh. With `settings.opacity` from its file: pictures of its materials (map_d, alpha of
/// glTF's modes MASK and BLEND, FBX's transparency), each with the file's cutoff unless the settings have one. A
/// material without a picture that is not opaque throughout, such as glass, is taken for opaque, with a warning:
/// without it all of its surface would be gone. Throws BadInput for pictures that are missing or not understood, for
/// one of the settings that is nowhere as opaque as the cutoff, and for textured faces without texture coordinates.
LoadedOpacity load_opacity(const ImportedMesh& mesh, const MaterialSettings& settings);

}  // namespace kiln
