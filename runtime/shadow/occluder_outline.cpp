// SPDX-License-Identifier: MIT
#include "runtime/shadow/occluder_outline.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <span>

#include "mesh/disjoint_sets.h"
#include "mesh/same_position.h"
#include "mesh/triangle_edges.h"

namespace kiln {

namespace {

constexpr std::size_t most_boxes = 8, most_flats = 8, most_corners = 8;
/// Distance, as a part of the mesh's radius, that the vertices of a flat part may be off its plane, and those of its
/// rim off its outline.
constexpr double flat_tolerance = 1e-4;
/// Cosine of the angle between neighbouring triangles of a flat part: what rounded positions turn small ones by.
constexpr double flat_cosine = 0.9999;

/// Space that a box takes from points that want no mesh around them; a flat box counts as a little thick.
double space_of(const BoundingBox& box, double thickness) {
  const Eigen::Vector3d sides = box.sides().cast<double>();
  return (sides.array() + thickness).prod();
}

/// Puts boxes around triangles of the mesh, cut again and again the one whose two halves leave out the most space.
std::vector<BoundingBox> boxes_around(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles) {
  struct Part {
    std::vector<std::uint32_t> triangles;
    BoundingBox box;
    double saved = 0;  // by its best cut: triangles whose middle is below `at`, and the others
    int axis = 0;
    float at = 0;
  };
  const auto middle = [&](std::uint32_t t, int axis) {
    const Triangle& corners = mesh.triangles[t];
    return (mesh.positions[corners[0]][axis] + mesh.positions[corners[1]][axis] + mesh.positions[corners[2]][axis]) / 3;
  };
  const auto extend = [&](BoundingBox& box, std::uint32_t t) {
    for (const std::uint32_t vertex : mesh.triangles[t]) box.extend(mesh.positions[vertex]);
  };
  double thickness = 0;
  const auto plan = [&](Part& part) {
    constexpr int places = 16;
    for (int axis = 0; axis < 3; ++axis)
      for (int place = 1; place < places; ++place) {
        const float at = part.box.lowest[axis] + part.box.sides()[axis] * static_cast<float>(place) / places;
        BoundingBox below, above;
        for (const std::uint32_t t : part.triangles) extend(middle(t, axis) < at ? below : above, t);
        if (below.is_empty() || above.is_empty()) continue;
        const double saved = space_of(part.box, thickness) - space_of(below, thickness) - space_of(above, thickness);
        if (saved <= part.saved) continue;
        part.saved = saved;
        part.axis = axis;
        part.at = at;
      }
  };
  if (triangles.empty()) return {};
  std::vector<Part> parts(1);
  parts[0].triangles = triangles;
  for (const std::uint32_t t : triangles) extend(parts[0].box, t);
  thickness = 0.01 * static_cast<double>(parts[0].box.diagonal());
  const double worthwhile = 0.04 * space_of(parts[0].box, thickness);
  plan(parts[0]);
  while (parts.size() < most_boxes) {
    Part& widest =
        *std::max_element(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.saved < b.saved; });
    if (widest.saved < worthwhile) break;
    Part low, high;
    for (const std::uint32_t t : widest.triangles) {
      Part& half = middle(t, widest.axis) < widest.at ? low : high;
      half.triangles.push_back(t);
      extend(half.box, t);
    }
    plan(low);
    plan(high);
    widest = std::move(low);
    parts.push_back(std::move(high));
  }
  std::vector<BoundingBox> boxes;
  for (const Part& part : parts) boxes.push_back(part.box);
  return boxes;
}

using Point2 = Eigen::Vector2d;

double cross_of(const Point2& a, const Point2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Returns the convex hull, counterclockwise, without corners that are on a line ([Andrew 1979]'s chains).
std::vector<Point2> hull_of(std::vector<Point2> points) {
  std::sort(points.begin(), points.end(),
            [](const Point2& a, const Point2& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); });
  std::vector<Point2> hull;
  for (int chain = 0; chain < 2; ++chain) {
    const std::size_t start = hull.size();
    for (const Point2& point : points) {
      while (hull.size() >= start + 2 && cross_of(hull.back() - hull[hull.size() - 2], point - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

double distance_to_outline(const std::vector<Point2>& hull, const Point2& point) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < hull.size(); ++k) {
    const Point2& next = hull[(k + 1) % hull.size()];
    const Point2 along = next - hull[k];
    const double share = std::clamp((point - hull[k]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (hull[k] + share * along - point).norm());
  }
  return least;
}

/// Leaves corners out, those first that take the least area with them, until few are left and all matter.
void keep_few_corners(std::vector<Point2>& hull, double least_area) {
  while (hull.size() > 3) {
    std::size_t least = 0;
    double area = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < hull.size(); ++k) {
      const Point2 &before = hull[(k + hull.size() - 1) % hull.size()], &after = hull[(k + 1) % hull.size()];
      const double own = 0.5 * cross_of(hull[k] - before, after - hull[k]);
      if (own < area) area = own, least = k;
    }
    if (hull.size() <= most_corners && area > least_area) return;
    hull.erase(hull.begin() + static_cast<std::ptrdiff_t>(least));
  }
}

struct FlatFound {
  double area;
  FlatPart part;
  std::vector<std::uint32_t> triangles;
};

/// Finds the plane through connected triangles that are nearly parallel, and the polygon that they fill; nothing if
/// they are not plane, or fill no convex polygon. `rims` are the vertices at their border.
std::optional<FlatFound> flat_part(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles,
                                   std::span<const std::uint32_t> rims, double radius) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
  double area = 0;
  for (const std::uint32_t t : triangles) {
    const Eigen::Vector3d twice = area_normal(mesh, mesh.triangles[t]).cast<double>();
    const double own = twice.norm();
    normal += twice;
    for (const std::uint32_t vertex : mesh.triangles[t]) centre += own / 3 * mesh.positions[vertex].cast<double>();
    area += own;
  }
  if (!(normal.norm() > 0)) return std::nullopt;
  centre /= area;
  // The plane through all corners, by the direction in which they spread least.
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const std::uint32_t t : triangles)
    for (const std::uint32_t vertex : mesh.triangles[t]) {
      const Eigen::Vector3d offset = mesh.positions[vertex].cast<double>() - centre;
      spread += offset * offset.transpose();
    }
  double off = 0;  // the plane
  normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
  for (const std::uint32_t t : triangles)
    for (const std::uint32_t vertex : mesh.triangles[t])
      off = std::max(off, std::abs(normal.dot(mesh.positions[vertex].cast<double>() - centre)));
  if (off > flat_tolerance * radius) return std::nullopt;
  const Eigen::Vector3d across = normal.unitOrthogonal(), up = normal.cross(across);
  std::vector<Point2> rim;
  for (const std::uint32_t vertex : rims) {
    const Eigen::Vector3d offset = mesh.positions[vertex].cast<double>() - centre;
    rim.emplace_back(offset.dot(across), offset.dot(up));
  }
  std::vector<Point2> hull = hull_of(rim);
  // Holes and notches have vertices within the hull.
  if (hull.size() < 3 || std::any_of(rim.begin(), rim.end(), [&](const Point2& point) {
        return distance_to_outline(hull, point) > flat_tolerance * radius;
      }))
    return std::nullopt;
  keep_few_corners(hull, flat_tolerance * flat_tolerance * radius * radius);
  FlatFound found{0.5 * area, {}, {triangles.begin(), triangles.end()}};
  double beyond = 0;
  for (const Point2& point : rim) beyond = std::max(beyond, distance_to_outline(hull, point));
  found.part.slack = static_cast<float>(off + beyond + 1e-5 * radius);
  for (const Point2& corner : hull)
    found.part.corners.push_back((centre + corner.x() * across + corner.y() * up).cast<float>());
  return found;
}

/// Finds flat parts of a mesh whose vertices are welded.
std::vector<FlatFound> flat_parts(const TriangleMesh& mesh, double radius) {
  const TriangleEdges edges(mesh.triangles);
  DisjointSets sets(mesh.triangles.size());
  const auto direction = [&](std::uint32_t t) {
    return area_normal(mesh, mesh.triangles[t]).cast<double>().normalized();
  };
  const auto is_shared = [&](std::span<const std::uint32_t> sides) {
    return sides.size() == 2 && run_opposite(mesh.triangles, sides[0], sides[1]);
  };
  edges.for_each([&](std::span<const std::uint32_t> sides) {
    if (is_shared(sides) && direction(sides[0] / 3).dot(direction(sides[1] / 3)) > flat_cosine)
      sets.join(sides[0] / 3, sides[1] / 3);
  });
  struct Group {
    std::vector<std::uint32_t> triangles, rims;
    double area = 0;
  };
  std::map<std::uint32_t, Group> groups;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    Group& group = groups[sets.root(t)];
    group.triangles.push_back(t);
    group.area += 0.5 * area_normal(mesh, mesh.triangles[t]).cast<double>().norm();
  }
  edges.for_each([&](std::span<const std::uint32_t> sides) {
    const bool inside = is_shared(sides) && sets.root(sides[0] / 3) == sets.root(sides[1] / 3);
    if (inside) return;
    for (const std::uint32_t side : sides) {
      Group& group = groups[sets.root(side / 3)];
      group.rims.push_back(vertex_at(mesh.triangles, side));
      group.rims.push_back(vertex_at(mesh.triangles, next_corner(side)));
    }
  });
  std::vector<FlatFound> found;
  for (const auto& [root, group] : groups) {
    if (group.area < 0.02 * std::numbers::pi * radius * radius || group.rims.empty()) continue;
    if (std::optional<FlatFound> part = flat_part(mesh, group.triangles, group.rims, radius))
      found.push_back(std::move(*part));
  }
  std::stable_sort(found.begin(), found.end(), [](const FlatFound& a, const FlatFound& b) { return a.area > b.area; });
  if (found.size() > most_flats) found.resize(most_flats);
  return found;
}

/// Sets the silhouette of a box as seen from the origin, the box given relative to it; no planes from within.
void look_at_box(const Eigen::Vector3f& lowest, const Eigen::Vector3f& highest, std::vector<Eigen::Vector3f>& planes) {
  planes.clear();
  // By face: whether the point is before it.
  bool front[3][2];
  bool outside = false;
  for (int axis = 0; axis < 3; ++axis) {
    front[axis][0] = lowest[axis] > 0;
    front[axis][1] = highest[axis] < 0;
    outside = outside || front[axis][0] || front[axis][1];
  }
  if (!outside) return;
  const Eigen::Vector3f centre = 0.5f * (lowest + highest);
  // An edge between a face before the point and one that is not is a part of the silhouette.
  for (int along = 0; along < 3; ++along) {
    const int a = (along + 1) % 3, b = (along + 2) % 3;
    for (const int side_a : {0, 1})
      for (const int side_b : {0, 1}) {
        if (front[a][side_a] == front[b][side_b]) continue;
        const float at_a = side_a == 0 ? lowest[a] : highest[a], at_b = side_b == 0 ? lowest[b] : highest[b];
        const float length = std::hypot(at_a, at_b);
        if (length < 1e-12f) continue;
        Eigen::Vector3f plane = Eigen::Vector3f::Zero();
        plane[a] = at_b / length;
        plane[b] = -at_a / length;
        if (plane.dot(centre) < 0) plane = -plane;
        planes.push_back(plane);
      }
  }
}

/// Sets the pyramid of a polygon as seen from `origin`; false where that is too near its plane.
bool look_at_flat(const FlatPart& flat, const Eigen::Vector3f& origin, float nearest, ViewPyramid& pyramid) {
  const std::vector<Eigen::Vector3f>& corners = flat.corners;
  std::vector<Eigen::Vector3f>& planes = pyramid.planes;
  planes.clear();
  const Eigen::Vector3f normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  const float height = normal.dot(corners[0] - origin);
  if (std::abs(height) < nearest) return false;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    // Corners go counterclockwise about the normal; from before the polygon the inside is on the left.
    const Eigen::Vector3f here = corners[k] - origin, next = corners[(k + 1) % corners.size()] - origin;
    const Eigen::Vector3f plane = here.cross(next);
    const float length = plane.norm();
    if (!(length > 0)) return false;
    planes.push_back((height > 0 ? 1.f : -1.f) / length * plane);
  }
  // A point beside an edge by the slack is off the edge's plane by no larger an angle than from straight before it.
  pyramid.margin = 1.5f * flat.slack / std::abs(height);
  return true;
}

void turn(const Eigen::Matrix3f& rotation, ViewPyramid& pyramid) {
  for (Eigen::Vector3f& plane : pyramid.planes) plane = rotation * plane;
}

}  // namespace

OccluderOutline outline_of(const TriangleMesh& mesh) {
  OccluderOutline outline;
  if (mesh.triangles.empty()) return outline;
  const double radius = 0.5 * static_cast<double>(bounding_box(mesh).diagonal());
  outline.nearest = static_cast<float>(3 * flat_tolerance * radius);
  const TriangleMesh welded = join_at_positions(mesh);
  std::vector<std::uint8_t> is_flat(welded.triangles.size(), 0);
  if (radius > 0)
    for (FlatFound& found : flat_parts(welded, radius)) {
      for (const std::uint32_t t : found.triangles) is_flat[t] = 1;
      outline.flats.push_back(std::move(found.part));
    }
  std::vector<std::uint32_t> others;
  for (std::uint32_t t = 0; t < welded.triangles.size(); ++t)
    if (is_flat[t] == 0) others.push_back(t);
  outline.boxes = boxes_around(welded, others);
  // Grows the boxes a little, for what rounding turns directions by.
  for (BoundingBox& box : outline.boxes) {
    box.lowest.array() -= static_cast<float>(1e-5 * radius);
    box.highest.array() += static_cast<float>(1e-5 * radius);
  }
  return outline;
}

void look_at_outline(const OccluderOutline& outline, const Placement& placement, const Eigen::Vector3d& point,
                     OutlineView& view) {
  const Eigen::Vector3f origin = placement.to_object(point).cast<float>();
  const Eigen::Matrix3f rotation = placement.rotation.cast<float>();
  view.boxes.resize(std::max(view.boxes.size(), outline.boxes.size() + outline.flats.size()));
  view.flats.resize(std::max(view.flats.size(), outline.flats.size()));
  view.box_count = view.flat_count = 0;
  for (const BoundingBox& box : outline.boxes) {
    ViewPyramid& pyramid = view.boxes[view.box_count++];
    look_at_box(box.lowest - origin, box.highest - origin, pyramid.planes);
    turn(rotation, pyramid);
  }
  for (const FlatPart& flat : outline.flats) {
    ViewPyramid& pyramid = view.flats[view.flat_count];
    if (look_at_flat(flat, origin, outline.nearest, pyramid)) {
      turn(rotation, pyramid);
      ++view.flat_count;
    } else {
      view.boxes[view.box_count++].planes.clear();  // anywhere
    }
  }
}

}  // namespace kiln
