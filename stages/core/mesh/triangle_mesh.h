// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace kiln {

using Triangle = std::array<std::uint32_t, 3>;

/// Transform from the positions of a mesh to the coordinates of its file: file = origin + 2^exponent * position. Meshes
/// of ordinary size near the origin have the identity, so their positions are those of the file. Others are moved and
/// scaled by a power of two, which rounds nothing, until float32 holds them.
struct MeshFrame {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< in the file's units
  int exponent = 0;

  bool operator==(const MeshFrame&) const = default;
  double unit() const { return std::ldexp(1.0, exponent); }  ///< length of 1 in the file's units
  Eigen::Vector3d to_file(const Eigen::Vector3d& position) const { return origin + unit() * position; }
  Eigen::Vector3d from_file(const Eigen::Vector3d& place) const { return (place - origin) / unit(); }
};

/// Indexed mesh that all rooms exchange. Object space, +Y up, right-handed; triangles wind counter-clockwise seen from
/// outside. Per-vertex attributes are empty or as many as the positions.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Triangle> triangles;
  std::vector<Eigen::Vector3f> normals;  ///< unit vectors
  std::vector<Eigen::Vector2f> uvs;      ///< (0,0) is the lower left corner of the atlas

  /// Red, green and blue from 0 to 1 as the file holds them; most files are sRGB-encoded, none say so.
  std::vector<Eigen::Vector3f> colors = {};

  /// Unit vectors at the corners of each triangle, where hard edges split the normals of a vertex; empty where
  /// `normals` hold at all corners. With corner normals, `normals` are their means.
  std::vector<std::array<Eigen::Vector3f, 3>> corner_normals = {};

  /// Uvs that textures of the artist's use, where `uvs` were made for an atlas beside them. They may lie outside the
  /// unit square, on top of one another, and be mirrored.
  std::vector<Eigen::Vector2f> texture_uvs = {};

  MeshFrame frame = {};
};

/// Returns the exponent of the frame of a mesh whose box has this longest side: 0 for ordinary sizes, a millionth to a
/// million.
int ordinary_exponent(double longest_side);

/// Axis-aligned box; empty (lowest > highest) until it is extended.
struct BoundingBox {
  Eigen::Vector3f lowest = Eigen::Vector3f::Constant(std::numeric_limits<float>::infinity());
  Eigen::Vector3f highest = Eigen::Vector3f::Constant(-std::numeric_limits<float>::infinity());

  bool is_empty() const { return (lowest.array() > highest.array()).any(); }
  Eigen::Vector3f centre() const { return 0.5f * (lowest + highest); }
  Eigen::Vector3f sides() const { return highest - lowest; }
  float diagonal() const { return is_empty() ? 0 : sides().norm(); }
  bool contains(const Eigen::Vector3f& point) const {
    return (point.array() >= lowest.array()).all() && (point.array() <= highest.array()).all();
  }

  /// Grows the box until it holds the point, or the other box.
  void extend(const Eigen::Vector3f& point) {
    lowest = lowest.cwiseMin(point);
    highest = highest.cwiseMax(point);
  }
  void merge(const BoundingBox& other) {
    lowest = lowest.cwiseMin(other.lowest);
    highest = highest.cwiseMax(other.highest);
  }
};

/// Returns the box around the vertices that triangles use.
BoundingBox bounding_box(const TriangleMesh& mesh);

/// Returns the box around points.
BoundingBox bounding_box(std::span<const Eigen::Vector3f> points);

/// Returns the normal at a corner (0 to 2) of a triangle of a mesh with normals.
inline const Eigen::Vector3f& corner_normal(const TriangleMesh& mesh, std::uint32_t triangle, std::size_t corner) {
  return mesh.corner_normals.empty() ? mesh.normals[mesh.triangles[triangle][corner]]
                                     : mesh.corner_normals[triangle][corner];
}

/// Sets `normals` to the average of the adjacent faces' normals, weighted by the angle at the vertex [Thuermer 1998],
/// and clears `corner_normals`. A vertex without a proper face gets +Y.
void compute_vertex_normals(TriangleMesh& mesh);

/// Appends the positions and triangles of a mesh to another that has no other attributes.
void append(TriangleMesh& whole, const TriangleMesh& part);

/// Returns the normal of a triangle by its winding, as long as twice its area.
Eigen::Vector3d area_normal(const TriangleMesh& mesh, const Triangle& triangle);

/// Tells whether a triangle has no area. Exact: differences and products of floats fit a double, unless the floats are
/// of very different size.
bool is_flat(const TriangleMesh& mesh, const Triangle& triangle);

/// Tells whether every edge has exactly two triangles, which run along it in opposite directions.
bool is_closed(const TriangleMesh& mesh);

/// Returns the surface's area.
double surface_area(const TriangleMesh& mesh);

}  // namespace kiln
