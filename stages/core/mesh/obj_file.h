#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace kiln {

/// A Wavefront OBJ file as it stands there, nothing joined or dropped: places, texture coordinates, faces of any number
/// of corners, and the names of their materials.
struct ObjFile {
  struct Corner {
    static constexpr std::uint32_t none = ~0u;
    std::uint32_t place = 0;
    std::uint32_t uv = none;  ///< `none`: the face has no texture coordinates
  };

  struct Face {
    std::uint32_t first_corner = 0;
    std::uint32_t corner_count = 0;  ///< three or more
    std::int32_t material = -1;      ///< -1: no `usemtl` before it
    int line = 0;                    ///< of the file, from 1
  };

  std::vector<Eigen::Vector3f> places;
  std::vector<Eigen::Vector2f> uvs;
  std::vector<Corner> corners;
  std::vector<Face> faces;  ///< at least one
  std::vector<std::string> materials;
  std::vector<std::string> libraries;  ///< what follows each `mtllib`: a file name, or several

  std::span<const Corner> corners_of(const Face& face) const {
    return std::span(corners).subspan(face.first_corner, face.corner_count);
  }
};

/// Reads `v`, `vt`, `f`, `usemtl` and `mtllib` lines; others say nothing of shape or surface. Throws BadInput, with the
/// line, for numbers that are not finite or not below 1e30, for faces of fewer than three corners and for corners that
/// are not there.
ObjFile read_obj(const std::filesystem::path& file);

/// Cuts the next word off a line.
std::string_view next_word(std::string_view& line);

/// A line without the spaces around it.
std::string_view trimmed(std::string_view line);

}  // namespace kiln
