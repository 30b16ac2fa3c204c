// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/thinnest_heights.h"

#include <algorithm>
#include <cstddef>

#include "mesh/mesh_components.h"
#include "simplify/triangle_shape.h"

namespace kiln {

std::vector<float> thinnest_heights(const TriangleMesh& mesh, double diagonal) {
  const Components components = find_components(mesh);
  const std::vector<BoundingBox> boxes = component_boxes(mesh, components);
  constexpr double coarsest = smallest_height_steps / 65'535, finest = smallest_height_steps / 16'777'215;
  std::vector<float> heights(mesh.positions.size(), 0);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const double share = static_cast<double>(boxes[components.of_triangle[i]].diagonal()) / diagonal;
    for (const std::uint32_t vertex : mesh.triangles[i])
      heights[vertex] = static_cast<float>(std::clamp(coarsest * share, finest, coarsest));
  }
  return heights;
}

}  // namespace kiln
