// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/high_parts.h"

#include <Eigen/Core>

#include "sh/ray_offset.h"

namespace kiln {

HighParts::HighParts(const TriangleMesh& high, const MatchPlan& plan, const SurfaceOpacity& opacity)
    : high_(high), scenes_(scenes_of_parts(high, plan.high_part, plan.count())) {
  if (plan.high_part.empty()) {
    std::vector<Triangle> enclosing;
    for (std::uint32_t t = 0; t < high.triangles.size(); ++t)
      if (!opacity.is_sheet(t)) enclosing.push_back(high.triangles[t]);
    whole_test_ = std::make_unique<BuriedTest>(high.positions, enclosing, rounding_offset(high.positions));
    return;
  }
  triangles_ = listed_by_part(plan.high_part, plan.count());
  for (std::vector<std::uint32_t>& part : triangles_)
    std::erase_if(part, [&](std::uint32_t t) { return opacity.is_sheet(t); });
}

std::vector<std::uint8_t> HighParts::buried(const Receivers& points, const std::vector<std::uint32_t>& parts) const {
  if (whole_test_) return (*whole_test_)(points);
  std::vector<std::uint8_t> buried(parts.size(), 0);
  const float offset = rounding_offset(high_.positions);
  const std::vector<std::vector<std::uint32_t>> points_of = listed_by_part(parts, triangles_.size());
  for (std::size_t part = 0; part < triangles_.size(); ++part) {
    std::vector<Eigen::Vector3f> positions, normals;
    for (const std::uint32_t k : points_of[part]) {
      positions.push_back(points.positions[k]);
      normals.push_back(points.normals[k]);
    }
    if (positions.empty()) continue;
    const TriangleMesh mesh = part_of_mesh(high_, triangles_[part]);
    const std::vector<std::uint8_t> of_part = BuriedTest(mesh.positions, mesh.triangles, offset)({positions, normals});
    for (std::size_t k = 0; k < of_part.size(); ++k) buried[points_of[part][k]] = of_part[k];
  }
  return buried;
}

}  // namespace kiln
