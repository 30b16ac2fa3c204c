// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "mesh/uv_raster.h"

namespace kiln {

/// Tangent frame as MikkTSpace defines it: tangent along +u, bitangent = sign * cross(normal, tangent); both are
/// interpolated over the triangle and NOT renormalised or made orthogonal per pixel.
struct TangentFrame {
  Eigen::Vector3f tangent = Eigen::Vector3f::UnitX();
  float sign = 1;
};

/// Computes one frame per vertex of a mesh with normals and uvs whose vertices are split at seams ([Mikkelsen 2008],
/// chapter 5: face tangents projected onto the vertex normal's plane, weighted by the corner's angle).
std::vector<TangentFrame> tangent_frames(const TriangleMesh& mesh);

/// Interpolates the frame at a texel: tangents linearly, the sign from the triangle's first corner.
TangentFrame interpolate(const TriangleMesh& mesh, const std::vector<TangentFrame>& frames, const TexelSource& source);

/// Converts `normal_tangent` (as a tangent-space normal map holds it) to object space, not normalised; `normal` and
/// `frame` are the interpolated vertex normal and frame.
Eigen::Vector3f to_object_space(const Eigen::Vector3f& normal_tangent, const Eigen::Vector3f& normal,
                                const TangentFrame& frame);

/// Inverts to_object_space, and normalises.
Eigen::Vector3f to_tangent_space(const Eigen::Vector3f& normal_object, const Eigen::Vector3f& normal,
                                 const TangentFrame& frame);

}  // namespace kiln
