// SPDX-License-Identifier: MIT
#include "runtime/shadow_gl/map_views.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace kiln {

namespace {

constexpr double narrowest_map = 1e-3;  // half-width at distance 1, of single directions
constexpr double margin = 1 + 1e-4;     // for what float32 rounds off directions at a light's edge

}  // namespace

bool MapView::may_see(const BoundingBall& ball) const {
  const double forward = axis.dot(ball.centre), slant = std::sqrt(1 + half_width * half_width);
  if (forward < -ball.radius) return false;
  // Sides of the pyramid have the normals (half_width * axis -+ right) / slant, and so on.
  const double aside = std::max(std::abs(right.dot(ball.centre)), std::abs(up.dot(ball.centre)));
  return (half_width * forward - aside) / slant >= -ball.radius;
}

MapView view_of_cone(const Eigen::Vector3d& axis, double half_angle) {
  const Eigen::Matrix3d turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).toRotationMatrix();
  return {turn.col(0), turn.col(1), turn.col(2), std::max(narrowest_map, margin * std::tan(half_angle))};
}

MapView view_of_face(int face) {
  const int axis = face / 2;
  MapView view;
  view.axis = (face % 2 == 0 ? 1.0 : -1.0) * Eigen::Vector3d::Unit(axis);
  view.right = Eigen::Vector3d::Unit((axis + 1) % 3);
  view.up = Eigen::Vector3d::Unit((axis + 2) % 3);
  return view;
}

MapRows rows_of(const MapView& view, const Placement& node, const Eigen::Vector3d& point) {
  Eigen::Matrix<double, 3, 4> rows;
  rows.leftCols<3>() = node.scale * node.rotation;
  rows.col(3) = node.translation - point;
  Eigen::Matrix3d turn;
  turn.row(0) = view.right / view.half_width;
  turn.row(1) = view.up / view.half_width;
  turn.row(2) = view.axis;
  return (turn * rows).cast<float>();
}

}  // namespace kiln
