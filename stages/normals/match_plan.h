// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "import/import_mesh.h"
#include "maps/asset_hints.h"
#include "mesh/triangle_mesh.h"
#include "normals/normals_settings.h"

namespace kiln {

/// Says what of the high mesh each triangle of an atlas may stand for, and how far rays look for it.
struct MatchPlan {
  std::vector<std::string> parts;        ///< names of the parts that are matched by name; none: all is one part
  std::vector<std::uint32_t> low_part;   ///< by triangle of the atlas; empty where `parts` is
  std::vector<std::uint32_t> high_part;  ///< by triangle of the high mesh; empty where `parts` is
  std::vector<double> part_cage;         ///< by part: its cage as a fraction of the diagonal, 0: that of all

  /// Offsets from the corners of the atlas's triangles to the artist's cage; empty where there is none.
  std::vector<std::array<Eigen::Vector3f, 3>> cage;

  std::vector<std::filesystem::path> files;  ///< that were read
  std::vector<std::string> warnings;

  std::size_t count() const { return std::max<std::size_t>(1, parts.size()); }
  std::uint32_t part_of_low(std::uint32_t triangle) const { return low_part.empty() ? 0 : low_part[triangle]; }
  std::uint32_t part_of_high(std::uint32_t triangle) const { return high_part.empty() ? 0 : high_part[triangle]; }
};

/// Makes the plan that the settings ask for. `low_file` is the artist's mesh that `atlas` was made of; where it is
/// empty, that of hints.low_file. Throws WrongUsage where the settings need that file and none is known, and for parts
/// of part_cage that there are not; BadInput where the atlas is of another mesh, names are missing, or parts of the
/// two meshes have no partner (pair_parts), and for a cage that does not fit (import_caged_mesh) or lies inside.
MatchPlan load_match_plan(const NormalsSettings& settings, std::filesystem::path low_file, const AssetHints& hints,
                          const TriangleMesh& atlas, const ImportedMesh& high);

}  // namespace kiln
