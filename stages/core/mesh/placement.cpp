// SPDX-License-Identifier: MIT
#include "mesh/placement.h"

#include <cmath>
#include <numbers>

#include "base/errors.h"
#include "base/numbers.h"

namespace kiln {

Eigen::Matrix4d Placement::matrix() const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.block<3, 3>(0, 0) = scale * rotation;
  m.block<3, 1>(0, 3) = translation;
  return m;
}

Eigen::Matrix3d turn_about_y(double degrees) {
  if (degrees == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(degrees * std::numbers::pi / 180, Eigen::Vector3d::UnitY()).toRotationMatrix();
}

Placement parse_placement(std::string_view name, std::string_view text) {
  const std::vector<double> numbers = parse_numbers(name, text, -1e6, 1e6);
  const auto fail = [&] {
    throw WrongUsage(std::string(name) + ": found '" + std::string(text) +
                     "'; expected X,Y,Z[,AZIMUTH[,SCALE]], a scale above 0");
  };
  if (numbers.size() < 3 || numbers.size() > 5) fail();
  Placement placement;
  placement.translation = {numbers[0], numbers[1], numbers[2]};
  if (numbers.size() > 3) placement.rotation = turn_about_y(numbers[3]);
  if (numbers.size() > 4) placement.scale = numbers[4];
  if (!(placement.scale > 0)) fail();
  return placement;
}

BoundingBox placed_box(const BoundingBox& box, const Placement& placement) {
  BoundingBox placed;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d at((corner & 1) != 0 ? box.highest[0] : box.lowest[0],
                             (corner & 2) != 0 ? box.highest[1] : box.lowest[1],
                             (corner & 4) != 0 ? box.highest[2] : box.lowest[2]);
    placed.extend(placement.to_scene(at).cast<float>());
  }
  return placed;
}

}  // namespace kiln
