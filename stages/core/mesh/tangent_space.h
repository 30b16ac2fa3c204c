#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "mesh/uv_raster.h"

namespace kiln {

/// A tangent frame as MikkTSpace defines it: tangent along +u, bitangent = sign * cross(normal, tangent); both
/// interpolated over the triangle and NOT renormalised or made orthogonal per pixel.
struct TangentFrame {
  Eigen::Vector3f tangent = Eigen::Vector3f::UnitX();
  float sign = 1;
};

/// One frame per vertex of a mesh with normals and uvs, vertices split at seams (Mikkelsen, "Simulation of wrinkled
/// surfaces revisited", 2008, chapter 5: face tangents projected onto the vertex normal's plane, weighted by the
/// corner's angle).
std::vector<TangentFrame> tangent_frames(const TriangleMesh& mesh);

/// The frame at a texel: tangents interpolated as they are, the sign of the triangle's first corner.
TangentFrame interpolate(const TriangleMesh& mesh, const std::vector<TangentFrame>& frames, const TexelSource& source);

/// `normal_tangent` (as a tangent-space normal map holds it) in object space, not yet normalised, where the
/// interpolated vertex normal and frame are `normal` and `frame`.
Eigen::Vector3f to_object_space(const Eigen::Vector3f& normal_tangent, const Eigen::Vector3f& normal,
                                const TangentFrame& frame);

/// The inverse of to_object_space, normalised.
Eigen::Vector3f to_tangent_space(const Eigen::Vector3f& normal_object, const Eigen::Vector3f& normal,
                                 const TangentFrame& frame);

}  // namespace kiln
