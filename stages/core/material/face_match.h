#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Faces of any number of corners as a file has them, each corner with its own texture coordinates.
struct TexturedFaces {
  struct Corner {
    std::uint32_t place = 0;
    Eigen::Vector2f uv = Eigen::Vector2f::Zero();
  };
  std::vector<Eigen::Vector3f> places;
  std::vector<Corner> corners;
  std::vector<std::uint32_t> first_corner;  ///< of each face, and one more: the number of corners

  std::size_t count() const { return first_corner.size() - 1; }
  std::span<const Corner> corners_of(std::size_t face) const {
    return std::span(corners).subspan(first_corner[face], first_corner[face + 1] - first_corner[face]);
  }
};

/// The face of the file that a triangle of a mesh comes from, and the texture coordinates of the triangle's corners.
struct TriangleSource {
  std::uint32_t face = 0;
  std::array<Eigen::Vector2f, 3> uvs;
};

/// For each triangle of `mesh` the face of `faces`, whose places are the mesh's before it was repaired, that it comes
/// from. Places alone decide, so that triangles may have been dropped, turned, reordered, taken apart or cut from
/// polygons: it is the face that has all three corners; of several that with the fewest corners, then the first. Where
/// there is none (a flat triangle was removed, a hole was filled) it is the nearest of those with most corners in
/// common, and other corners have the texture coordinates of the face's nearest point. Throws std::invalid_argument for
/// a mesh with a place that no face has.
std::vector<TriangleSource> match_faces(const TriangleMesh& mesh, const TexturedFaces& faces);

}  // namespace kiln
