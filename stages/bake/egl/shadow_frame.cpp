// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/egl/shadow_frame.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <vector>

namespace kiln {

namespace {

/// Returns the corners of the convex hull in counter-clockwise order [Andrew 1979]; one or two if all points lie on a
/// point or a line.
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points) {
  const auto before = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  };
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Eigen::Vector2d> hull;
  const auto turns_left = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x()) > 0;
  };
  const auto extend = [&](const Eigen::Vector2d& point, std::size_t lowest) {
    while (hull.size() >= lowest + 2 && !turns_left(hull[hull.size() - 2], hull.back(), point)) hull.pop_back();
    hull.push_back(point);
  };
  for (const Eigen::Vector2d& point : points) extend(point, 0);
  const std::size_t upper = hull.size() - 1;
  for (auto point = points.rbegin() + 1; point != points.rend(); ++point) extend(*point, upper);
  hull.pop_back();
  return hull;
}

struct Rectangle {
  Eigen::Vector2d axis = Eigen::Vector2d::UnitX();
  Eigen::Vector2d lowest = Eigen::Vector2d::Zero();  // least coordinates along the axis and across it
  Eigen::Vector2d highest = Eigen::Vector2d::Zero();

  double area() const { return (highest - lowest).prod(); }
};

Rectangle rectangle_along(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& axis) {
  const Eigen::Vector2d across(-axis.y(), axis.x());
  Rectangle rectangle{axis, Eigen::Vector2d::Constant(std::numeric_limits<double>::max()),
                      Eigen::Vector2d::Constant(std::numeric_limits<double>::lowest())};
  for (const Eigen::Vector2d& point : points) {
    const Eigen::Vector2d at(point.dot(axis), point.dot(across));
    rectangle.lowest = rectangle.lowest.cwiseMin(at);
    rectangle.highest = rectangle.highest.cwiseMax(at);
  }
  return rectangle;
}

Rectangle least_rectangle(const std::vector<Eigen::Vector2d>& hull) {
  Rectangle best = rectangle_along(hull, Eigen::Vector2d::UnitX());
  for (std::size_t i = 0; hull.size() >= 3 && i < hull.size(); ++i) {
    const Rectangle candidate = rectangle_along(hull, (hull[(i + 1) % hull.size()] - hull[i]).normalized());
    if (candidate.area() < best.area()) best = candidate;
  }
  return best;
}

}  // namespace

ShadowFrame fit_shadow_frame(std::span<const Eigen::Vector3f> hull, const Eigen::Vector3f& direction, int size_texels,
                             int margin_texels) {
  const Eigen::Vector3d towards_light = direction.cast<double>().normalized();
  const Eigen::Vector3d first = towards_light.unitOrthogonal(), second = towards_light.cross(first);

  // Step 1: project, and find the extent along the direction.
  std::vector<Eigen::Vector2d> projected;
  projected.reserve(hull.size());
  double nearest = std::numeric_limits<double>::lowest(), farthest = std::numeric_limits<double>::max();
  for (const Eigen::Vector3f& point : hull) {
    const Eigen::Vector3d p = point.cast<double>();
    projected.emplace_back(p.dot(first), p.dot(second));
    nearest = std::max(nearest, p.dot(towards_light));
    farthest = std::min(farthest, p.dot(towards_light));
  }

  // Step 2: find the least rectangle, not thinner than a hair (a flat object seen edge on), with its margin.
  const Rectangle rectangle = least_rectangle(convex_hull(std::move(projected)));
  const double hair = 1e-6 * std::max({(rectangle.highest - rectangle.lowest).maxCoeff(), nearest - farthest, 1e-30});
  const Eigen::Vector2d centre = 0.5 * (rectangle.lowest + rectangle.highest);
  const Eigen::Vector2d extent =
      (rectangle.highest - rectangle.lowest).cwiseMax(hair) * size_texels / (size_texels - 2.0 * margin_texels);
  const double depth_margin = 1e-3 * std::max(nearest - farthest, hair);
  const double depth_extent = nearest - farthest + 2 * depth_margin;

  // Step 3: make the rows that map a point to the map and to its depth.
  const Eigen::Vector3d u = rectangle.axis.x() * first + rectangle.axis.y() * second;
  const Eigen::Vector3d v = -rectangle.axis.y() * first + rectangle.axis.x() * second;
  const auto row = [](const Eigen::Vector3d& axis, double offset, double scale) {
    return Eigen::Vector4f((Eigen::Vector4d(axis.x(), axis.y(), axis.z(), offset) * scale).cast<float>());
  };
  ShadowFrame frame;
  frame.row_u = row(u, 0.5 * extent.x() - centre.x(), 1 / extent.x());
  frame.row_v = row(v, 0.5 * extent.y() - centre.y(), 1 / extent.y());
  frame.row_depth = row(-towards_light, nearest + depth_margin, 1 / depth_extent);
  frame.width = static_cast<float>(extent.x());
  frame.height = static_cast<float>(extent.y());
  frame.depth = static_cast<float>(depth_extent);
  return frame;
}

}  // namespace kiln
