// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/high_parts.h"

#include <Eigen/Core>

#include "sh/ray_offset.h"

namespace kiln {

HighParts::HighParts(const TriangleMesh& high, const MatchPlan& plan)
    : scenes_(scenes_of_parts(high, plan.high_part, plan.count())) {
  const float offset = rounding_offset(high.positions);
  if (plan.high_part.empty())
    tests_.push_back(std::make_unique<BuriedTest>(high.positions, high.triangles, offset));
  else
    for (const std::vector<std::uint32_t>& triangles : listed_by_part(plan.high_part, plan.count()))
      tests_.push_back(std::make_unique<BuriedTest>(high.positions, chosen(high.triangles, triangles), offset));
}

std::vector<std::uint8_t> HighParts::buried(const Receivers& points, const std::vector<std::uint32_t>& parts) const {
  if (tests_.size() == 1) return (*tests_[0])(points);
  std::vector<std::uint8_t> buried(parts.size(), 0);
  const std::vector<std::vector<std::uint32_t>> points_of = listed_by_part(parts, tests_.size());
  for (std::size_t part = 0; part < tests_.size(); ++part) {
    std::vector<Eigen::Vector3f> positions, normals;
    for (const std::uint32_t k : points_of[part]) {
      positions.push_back(points.positions[k]);
      normals.push_back(points.normals[k]);
    }
    if (positions.empty()) continue;
    const std::vector<std::uint8_t> of_part = (*tests_[part])({positions, normals});
    for (std::size_t k = 0; k < of_part.size(); ++k) buried[points_of[part][k]] = of_part[k];
  }
  return buried;
}

}  // namespace kiln
