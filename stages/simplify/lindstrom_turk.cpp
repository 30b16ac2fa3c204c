// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/lindstrom_turk.h"

#include <Eigen/Geometry>
#include <cmath>

namespace kiln {

namespace {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;

constexpr double squared_sin_smallest_angle = 3.0459e-4;  // of 1 degree
constexpr double squared_cos_smallest_angle = 1 - squared_sin_smallest_angle;

/// Returns the matrix of w -> e x (w x e): the second derivative of the squared area between a feature edge e and a
/// point.
Matrix across(const Vector& e) { return e.squaredNorm() * Matrix::Identity() - e * e.transpose(); }

}  // namespace

TrianglePlane::TrianglePlane(const Vector& a, const Vector& b, const Vector& c)
    : normal((b - a).cross(c - a)), offset(normal.dot(a)) {}

void PlacementConstraints::add(const Vector& row, double value) {
  const double squared = row.squaredNorm();
  if (!(squared > 0) || size_ == 3) return;
  if (size_ == 1 && std::pow(rows_[0].dot(row), 2) > squared_cos_smallest_angle * squared) return;
  if (size_ == 2) {
    const Vector free = rows_[0].cross(rows_[1]);
    if (std::pow(free.dot(row), 2) <= squared_sin_smallest_angle * free.squaredNorm() * squared) return;
  }
  const double length = std::sqrt(squared);
  rows_[size_] = row / length;
  values_[size_] = value / length;
  ++size_;
}

void PlacementConstraints::add_minimum(const Matrix& H, const Vector& c) {
  if (size_ == 0) {
    for (int i = 0; i < 3; ++i) add(H.row(i).transpose(), -c[i]);
  } else if (size_ == 1) {
    const Vector& row = rows_[0];
    Eigen::Index largest;
    row.cwiseAbs().maxCoeff(&largest);
    Vector first;
    if (largest == 0) first = {-row.z() / row.x(), 0, 1};
    if (largest == 1) first = {0, -row.z() / row.y(), 1};
    if (largest == 2) first = {1, 0, -row.x() / row.z()};
    const Vector second = row.cross(first);
    add(H * first, -first.dot(c));
    add(H * second, -second.dot(c));
  } else if (size_ == 2) {
    const Vector free = rows_[0].cross(rows_[1]);
    add(H * free, -free.dot(c));
  }
}

Vector PlacementConstraints::solve() const {
  // Apply Cramer's rule.
  const Vector across_12 = rows_[1].cross(rows_[2]), across_20 = rows_[2].cross(rows_[0]),
               across_01 = rows_[0].cross(rows_[1]);
  return (values_[0] * across_12 + values_[1] * across_20 + values_[2] * across_01) / rows_[0].dot(across_12);
}

PlacementConstraints lindstrom_turk_constraints(const EdgeSurroundings& edge) {
  PlacementConstraints constraints;
  if (!edge.features.empty()) {
    // Preserve the line: the areas between its edges and the point add up to nothing.
    Vector along = Vector::Zero(), area = Vector::Zero();
    for (const FeatureEdge& feature : edge.features) {
      along += feature.to - feature.from;
      area += feature.to.cross(feature.from);
    }
    constraints.add_minimum(across(along), along.cross(area));
  }
  Matrix H = Matrix::Zero();
  Vector c = Vector::Zero(), normal = Vector::Zero();
  double offset = 0;
  for (const TrianglePlane& plane : edge.planes) {
    normal += plane.normal;
    offset += plane.offset;
    H.noalias() += plane.normal * plane.normal.transpose();
    c -= plane.offset * plane.normal;
  }
  constraints.add(normal, offset);
  if (constraints.size() == 3) return constraints;
  for (const FeatureEdge& feature : edge.features) {
    const Vector along = feature.to - feature.from;
    H += 9 * edge.squared_length * across(along);
    c += 9 * edge.squared_length * along.cross(feature.to.cross(feature.from));
  }
  constraints.add_minimum(H, c);
  return constraints;
}

double lindstrom_turk_cost(const EdgeSurroundings& edge, const Vector& v) {
  double volume = 0, area = 0;
  for (const TrianglePlane& plane : edge.planes) {
    const double six_volumes = plane.normal.dot(v) - plane.offset;
    volume += six_volumes * six_volumes;
  }
  for (const FeatureEdge& feature : edge.features)
    area += (feature.to - feature.from).cross(v - feature.from).squaredNorm();
  return 0.5 * volume / 36 + 0.5 * edge.squared_length * area / 4;
}

}  // namespace kiln
