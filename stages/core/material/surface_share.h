// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "import/import_mesh.h"
#include "material/channel_texture.h"

namespace kiln {

/// A share from 0 to 1 that each place of a mesh has of something, such as roughness. Copies share large data. May be
/// used by several threads at once.
class SurfaceShare {
 public:
  /// Share of one material: its factor times its texture.
  struct Material {
    float factor = 1;
    std::shared_ptr<const ChannelTexture> texture = nullptr;  ///< null: none
    Eigen::Matrix<float, 2, 3> texture_transform = Eigen::Matrix<float, 2, 3>::Identity();
    ChannelTexture::Wrap wrap_u = ChannelTexture::Wrap::repeat, wrap_v = ChannelTexture::Wrap::repeat;
  };

  /// Materials of triangles, and the texture coordinates of these.
  struct Materials {
    std::vector<Material> all;
    std::vector<std::uint32_t> of_triangle;
    std::vector<std::array<Eigen::Vector2f, 3>> uvs;  ///< one per triangle, or none without textures
  };

  /// Makes a share that is the same everywhere.
  explicit SurfaceShare(float constant = 1) : constant_(constant) {}

  explicit SurfaceShare(Materials materials);

  /// Returns the share at a point of a triangle: u is the weight of the second corner, v that of the third.
  float at(std::uint32_t triangle, float u, float v) const;

  bool is_constant() const { return materials_ == nullptr; }
  float constant_value() const { return constant_; }
  /// Returns the materials of a share that is not constant.
  const Materials& materials() const { return *materials_; }

 private:
  float constant_;
  std::shared_ptr<const Materials> materials_;
};

/// A share as loaded, and the files that were read for it.
struct LoadedShare {
  SurfaceShare share;
  std::vector<std::filesystem::path> files;
};

/// Loads the share that `member` names of a mesh's materials; faces whose material does not give it have `otherwise`.
/// Messages about missing pictures end in `option`, which helps without them.
/// Throws BadInput for pictures that are missing or not understood, and for textured faces without texture coordinates.
LoadedShare load_share(const ImportedMesh& mesh, SourceShare SourceMaterial::*member, float otherwise,
                       const std::string& option);

}  // namespace kiln
