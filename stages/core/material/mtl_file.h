#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace kiln {

/// What a Wavefront MTL file says of one material's diffuse reflectance.
struct MtlMaterial {
  std::string name;
  Eigen::Vector3f diffuse = Eigen::Vector3f::Ones();  ///< Kd as in the file; 1 where it has none
  bool has_diffuse = false;

  std::filesystem::path texture;                             ///< map_Kd, with its folder; empty: none
  Eigen::Vector2f texture_scale{1, 1};                       ///< -s
  Eigen::Vector2f texture_offset = Eigen::Vector2f::Zero();  ///< -o; looked up at scale * uv + offset
  bool texture_clamp = false;                                ///< -clamp on: not repeated

  int line = 0;          ///< of newmtl
  int texture_line = 0;  ///< of map_Kd
};

/// Reads `newmtl`, `Kd` and `map_Kd` lines. Throws BadInput, with the line, for a Kd that is no colour of finite
/// numbers and for an option of map_Kd that changes values (-mm, -t, -imfchan).
std::vector<MtlMaterial> read_mtl(const std::filesystem::path& file);

}  // namespace kiln
