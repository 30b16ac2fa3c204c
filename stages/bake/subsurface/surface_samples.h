// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bake/scene/receiver_set.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Surface as discs that together have its area.
struct SurfaceSamples {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;
  std::vector<float> areas;

  std::size_t size() const { return positions.size(); }
};

/// Returns the area of the surface that each covered texel stands for, in square object units: that of the atlas'
/// triangles within the texel's square, divided by the cosine between the triangle and the receiver's normal (at least
/// 1/4), which is how much larger the surface is that the texel was projected from. What lies in texels whose centre no
/// triangle covers goes to the covered neighbour nearest to it.
std::vector<float> texel_areas(const TriangleMesh& atlas, const ReceiverSet& receivers);

/// Returns the area that each receiver stands for, where receivers are the vertices of `mesh`: a third of every
/// triangle around it.
std::vector<float> vertex_areas(const TriangleMesh& mesh, const ReceiverSet& receivers);

}  // namespace kiln
