// SPDX-License-Identifier: GPL-3.0-or-later
#include "probes/winding.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace kiln {

double winding_number(const TriangleMesh& mesh, const Eigen::Vector3f& point) {
  double sum = 0;
  for (const Triangle& triangle : mesh.triangles) {
    Eigen::Vector3d corner[3];
    double length[3];
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = (mesh.positions[triangle[k]] - point).cast<double>();
      length[k] = corner[k].norm();
    }
    const double volume = corner[0].dot(corner[1].cross(corner[2]));
    const double edges = length[0] * length[1] * length[2] + corner[0].dot(corner[1]) * length[2] +
                         corner[1].dot(corner[2]) * length[0] + corner[2].dot(corner[0]) * length[1];
    sum += std::atan2(volume, edges);  // half the solid angle
  }
  return sum / (2 * std::numbers::pi);
}

}  // namespace kiln
