// SPDX-License-Identifier: GPL-3.0-or-later
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

/// Picture that a mesh file names or embeds.
struct SourcePicture {
  std::filesystem::path file;                              ///< with its folder; the mesh file for an embedded picture
  std::shared_ptr<const std::vector<std::uint8_t>> bytes;  ///< PNG or JPEG of an embedded picture; else null
  std::string name;                                        ///< for messages: the file's name, or "image 3 of scene.glb"
};

/// Picture of a material, and how it is looked up.
struct SourceTexture {
  enum class Wrap { repeat, clamp, mirror };

  SourcePicture picture;
  std::string place;  ///< place where the mesh file names it, for messages
  /// Transform of the lookup: transform * (u, v, 1), where (0, 0) is the picture's lower left corner.
  Eigen::Matrix<float, 2, 3> transform = Eigen::Matrix<float, 2, 3>::Identity();
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  float base = 0, gain = 1;  ///< stored values become base + gain * value (-mm)
};

/// Share of 0 to 1 that a material has of something: a number, times one channel of a picture.
struct SourceShare {
  /// Channel of the picture. `coverage` is alpha where the picture has any that is not 1, else its grey.
  enum class Channel { red, green, blue, alpha, coverage, grey };

  std::optional<float> factor = {};  ///< 0 to 1; nothing: the file does not say, and 1 beside a picture
  std::optional<SourceTexture> texture = {};
  Channel channel = Channel::grey;

  bool is_given() const { return factor.has_value() || texture.has_value(); }
};

/// Material of a file.
struct SourceMaterial {
  using Wrap = SourceTexture::Wrap;

  std::string name;
  std::string place;                                  ///< place in the file, for messages: "scan.mtl:3"
  Eigen::Vector3f diffuse = Eigen::Vector3f::Ones();  ///< diffuse reflectance, 0 to 1
  bool has_diffuse = false;                           ///< the file gives `diffuse`
  bool linear_diffuse = false;           ///< `diffuse` is proportional to light whatever the settings say (glTF)
  std::optional<SourceTexture> texture;  ///< of the diffuse reflectance

  SourceShare opacity;         ///< not given: opaque
  float opacity_cutoff = .5f;  ///< opacity below which nothing is there, above 0 and below 1
  SourceShare roughness, metalness;
  /// Light of its own: factors, not below 0, proportional to light; times a picture of colours.
  std::optional<Eigen::Vector3f> emission;
  std::optional<SourceTexture> emission_texture;
};

/// Mesh file as it is, with nothing joined, turned or dropped: the output of every reader and the input of every stage.
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
    std::uint32_t line = 0;             ///< line in a text file, from 1; 0: the format has no lines
    std::int32_t part = -1;             ///< entry of `parts`; -1: the file does not name it
  };

  std::vector<Eigen::Vector3d> places;   ///< in the file's units and axes; those that faces use are finite
  std::vector<Eigen::Vector3f> colors;   ///< as many as places, or none; 0 to 1
  bool linear_colors = false;            ///< `colors` are proportional to light whatever the settings say (glTF)
  std::vector<Eigen::Vector3f> normals;  ///< not normalised; those that faces use are finite
  std::vector<Eigen::Vector2f> uvs;      ///< (0, 0) is a picture's lower left corner
  std::vector<Corner> corners;
  std::vector<Face> faces;         ///< at least one
  std::vector<std::string> parts;  ///< names of the objects or groups that the file divides its faces into, each once
  std::vector<SourceMaterial> materials;
  /// Reason why the file's materials cannot be used, such as a missing library or picture; faces have none then. Only
  /// code that needs materials throws it: the shape is complete without them.
  std::optional<BadInput> materials_fault;
  bool has_smoothing_groups = false;  ///< faces without one are flat then

  /// Whether the format repeats vertices for every face (STL), so that merging them is not a repair.
  bool is_unwelded = false;
  /// Upper bound of one unit of the coordinates' last digit: 0 for doubles, 2^-23 times the largest for floats, 10^-6
  /// for text of six decimals. Vertices closer than a few such units may be meant to be one.
  double precision = 0;

  std::vector<std::filesystem::path> further_files;  ///< files that were read besides: material libraries, buffers
  /// Parts of the file that are not used, and faults mended in reading: whole sentences without a full stop, each once.
  std::vector<std::string> warnings;

  std::span<const Corner> corners_of(const Face& face) const {
    return std::span(corners).subspan(face.first_corner, face.corner_count);
  }
};

}  // namespace kiln
