#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/errors.h"

namespace kiln {

/// A picture that a mesh file names, or holds within itself.
struct SourcePicture {
  std::filesystem::path file;                              ///< with its folder; of an embedded picture the mesh file
  std::shared_ptr<const std::vector<std::uint8_t>> bytes;  ///< of an embedded picture, as PNG or JPEG; else null
  std::string name;                                        ///< for messages: the file's name, or "image 3 of scene.glb"
};

/// What a file says of one material's diffuse reflectance.
struct SourceMaterial {
  enum class Wrap { repeat, clamp, mirror };

  std::string name;
  std::string place;                                  ///< where it stands, for messages: "scan.mtl:3"
  Eigen::Vector3f diffuse = Eigen::Vector3f::Ones();  ///< 0 to 1
  bool has_diffuse = false;                           ///< whether the file gives `diffuse`
  bool linear_diffuse = false;  ///< `diffuse` is proportional to light whatever the settings say (glTF)

  std::optional<SourcePicture> texture;
  std::string texture_place;  ///< where it is named, for messages
  /// The picture is looked up at texture_transform * (u, v, 1), where (0, 0) is its lower left corner.
  Eigen::Matrix<float, 2, 3> texture_transform = Eigen::Matrix<float, 2, 3>::Identity();
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  float texture_base = 0, texture_gain = 1;  ///< of stored values: base + gain * value (-mm)
};

/// A mesh file as it stands, nothing joined, turned or dropped: what every reader gives and every stage starts from.
struct SourceMesh {
  static constexpr std::uint32_t none = ~0u;

  struct Corner {
    std::uint32_t place = 0;
    std::uint32_t uv = none;
    std::uint32_t normal = none;
  };
  struct Face {
    std::uint32_t first_corner = 0;
    std::uint32_t corner_count = 0;     ///< three or more
    std::int32_t material = -1;         ///< -1: none
    std::uint32_t smoothing_group = 0;  ///< 0: none; faces of one group are smooth across their edges
    std::uint32_t line = 0;             ///< of a text file, from 1; 0: the format has no lines
  };

  std::vector<Eigen::Vector3d> places;   ///< in the file's units and axes; those that faces use are finite
  std::vector<Eigen::Vector3f> colors;   ///< as many as places, or none; 0 to 1
  bool linear_colors = false;            ///< `colors` are proportional to light whatever the settings say (glTF)
  std::vector<Eigen::Vector3f> normals;  ///< of any length; those that faces use are finite
  std::vector<Eigen::Vector2f> uvs;      ///< (0, 0) is a picture's lower left corner
  std::vector<Corner> corners;
  std::vector<Face> faces;  ///< at least one
  std::vector<SourceMaterial> materials;
  /// Why the file's materials cannot be used, such as a library or a picture that is missing; faces have none then. To
  /// be thrown by what needs materials, and by nothing else: shape is whole without them.
  std::optional<BadInput> materials_fault;
  bool has_smoothing_groups = false;  ///< faces without one are flat then

  /// Whether vertices stand in the file once for every face (STL), so that merging them is no repair.
  bool is_unwelded = false;
  /// What one unit of the last digit of the coordinates is worth at most: 0 for doubles, 2^-23 times the largest for
  /// floats, 10^-6 for text of six decimals. Vertices that are nearer than a few of them may be meant to be one.
  double precision = 0;

  std::vector<std::filesystem::path> further_files;  ///< that were read besides: material libraries, buffers
  /// What the file has and is not used, or was mended in reading: whole sentences without a full stop, each once.
  std::vector<std::string> warnings;

  std::span<const Corner> corners_of(const Face& face) const {
    return std::span(corners).subspan(face.first_corner, face.corner_count);
  }
};

}  // namespace kiln
