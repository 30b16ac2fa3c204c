#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace kiln {

using Triangle = std::array<std::uint32_t, 3>;

/// The neutral indexed mesh that all rooms exchange. Object space, +Y up, right-handed; triangles wind
/// counter-clockwise seen from outside. Per-vertex attributes are empty or as many as the positions.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Triangle> triangles;
  std::vector<Eigen::Vector3f> normals;  ///< unit vectors
  std::vector<Eigen::Vector2f> uvs;      ///< (0,0) is the lower left corner of the atlas

  /// Red, green and blue from 0 to 1 as the file holds them; most files' are sRGB-encoded, none say so.
  std::vector<Eigen::Vector3f> colors = {};
};

/// An axis-aligned box; empty (lowest > highest) for a mesh without vertices.
struct BoundingBox {
  Eigen::Vector3f lowest = Eigen::Vector3f::Constant(std::numeric_limits<float>::infinity());
  Eigen::Vector3f highest = Eigen::Vector3f::Constant(-std::numeric_limits<float>::infinity());

  Eigen::Vector3f centre() const { return 0.5f * (lowest + highest); }
  float diagonal() const { return (highest - lowest).norm(); }
};

/// The box around the vertices that triangles refer to.
BoundingBox bounding_box(const TriangleMesh& mesh);

/// Sets `normals` to the average of the adjacent faces' normals, weighted by the angle at the vertex (Thuermer and
/// Wuethrich, "Computing vertex normals from polygonal facets", 1998). A vertex with no proper face gets +Y.
void compute_vertex_normals(TriangleMesh& mesh);

/// Whether every edge has exactly two triangles, which run along it in opposite directions.
bool is_closed(const TriangleMesh& mesh);

/// The surface's area.
double surface_area(const TriangleMesh& mesh);

}  // namespace kiln
