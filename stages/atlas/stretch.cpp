// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/stretch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace kiln {

void StretchSum::add(const std::array<Eigen::Vector3d, 3>& q, const std::array<Eigen::Vector2d, 3>& p) {
  const double area = 0.5 * (q[1] - q[0]).cross(q[2] - q[0]).norm();
  const double uv_area = 0.5 * cross(p[0], p[1], p[2]);
  if (!(area > 0)) return;
  area_ += area;
  if (!(uv_area > 0)) {
    square_sum_ = largest_ = std::numeric_limits<double>::infinity();
    return;
  }
  uv_area_ += uv_area;
  // Partial derivatives of the surface by s and t: equations of section 3.
  const Eigen::Vector3d by_s =
      (q[0] * (p[1].y() - p[2].y()) + q[1] * (p[2].y() - p[0].y()) + q[2] * (p[0].y() - p[1].y())) / (2 * uv_area);
  const Eigen::Vector3d by_t =
      (q[0] * (p[2].x() - p[1].x()) + q[1] * (p[0].x() - p[2].x()) + q[2] * (p[1].x() - p[0].x())) / (2 * uv_area);
  const double a = by_s.dot(by_s), b = by_s.dot(by_t), c = by_t.dot(by_t);
  const double root = std::sqrt((a - c) * (a - c) + 4 * b * b);
  largest_ = std::max(largest_, std::sqrt(0.5 * (a + c + root)));
  square_sum_ += 0.5 * (a + c) * area;
}

Stretch StretchSum::result() const {
  if (!(area_ > 0)) return {};
  const double scale = std::sqrt(uv_area_ / area_);
  return {std::sqrt(square_sum_ / area_) * scale, largest_ * scale};
}

Stretch measure_stretch(const Surface& surface, const Chart& chart) {
  StretchSum sum;
  for (std::size_t i = 0; i < chart.faces.size(); ++i) {
    const Triangle& t = chart.triangles[i];
    std::array<Eigen::Vector3d, 3> corners;
    for (int k = 0; k < 3; ++k) corners[k] << surface.rest[chart.faces[i]].corners[k], 0;
    sum.add(corners, {chart.uvs[t[0]], chart.uvs[t[1]], chart.uvs[t[2]]});
  }
  return sum.result();
}

Stretch measure_stretch(const TriangleMesh& atlas) {
  StretchSum sum;
  for (const Triangle& t : atlas.triangles) {
    std::array<Eigen::Vector3d, 3> corners;
    std::array<Eigen::Vector2d, 3> uvs;
    for (int k = 0; k < 3; ++k) {
      corners[k] = atlas.positions[t[k]].cast<double>();
      uvs[k] = atlas.uvs[t[k]].cast<double>();
    }
    if (cross(uvs[0], uvs[1], uvs[2]) != 0) sum.add(corners, uvs);
  }
  return sum.result();
}

}  // namespace kiln
