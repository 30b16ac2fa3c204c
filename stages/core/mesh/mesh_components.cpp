// SPDX-License-Identifier: MIT
#include "mesh/mesh_components.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mesh/disjoint_sets.h"
#include "mesh/triangle_edges.h"
#include "mesh/winding.h"

namespace kiln {

namespace {

struct ComponentShape {
  BoundingBox box;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< one of its vertices
  double six_volumes = 0;
  double double_area = 0;
  bool started = false;
  std::vector<std::uint32_t> triangles;  ///< filled only where needed
};

std::array<Eigen::Vector3d, 3> corners_from(const TriangleMesh& mesh, const Triangle& t,
                                            const Eigen::Vector3d& origin) {
  return {mesh.positions[t[0]].cast<double>() - origin, mesh.positions[t[1]].cast<double>() - origin,
          mesh.positions[t[2]].cast<double>() - origin};
}

std::vector<ComponentShape> measure(const TriangleMesh& mesh, const Components& components) {
  std::vector<ComponentShape> shapes(components.count);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    ComponentShape& shape = shapes[components.of_triangle[i]];
    if (!shape.started) shape.origin = mesh.positions[t[0]].cast<double>();
    shape.started = true;
    const auto [a, b, c] = corners_from(mesh, t, shape.origin);
    shape.six_volumes += a.dot(b.cross(c));
    shape.double_area += (b - a).cross(c - a).norm();
    for (const std::uint32_t vertex : t) shape.box.extend(mesh.positions[vertex]);
  }
  return shapes;
}

}  // namespace

Components find_components(const TriangleMesh& mesh) {
  DisjointSets sets(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    sets.join(t[0], t[1]);
    sets.join(t[0], t[2]);
  }
  Components components;
  components.of_triangle.resize(mesh.triangles.size());
  constexpr std::uint32_t none_yet = ~0u;
  std::vector<std::uint32_t> number(mesh.positions.size(), none_yet);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    std::uint32_t& component = number[sets.root(mesh.triangles[i][0])];
    if (component == none_yet) component = static_cast<std::uint32_t>(components.count++);
    components.of_triangle[i] = component;
  }
  return components;
}

std::vector<BoundingBox> component_boxes(const TriangleMesh& mesh, const Components& components) {
  std::vector<BoundingBox> boxes(components.count);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const std::uint32_t vertex : mesh.triangles[i])
      boxes[components.of_triangle[i]].extend(mesh.positions[vertex]);
  return boxes;
}

std::vector<std::uint8_t> closed_components(const TriangleMesh& mesh, const Components& components) {
  std::vector<std::uint8_t> closed(components.count, 1);
  TriangleEdges(mesh.triangles).for_each([&](std::span<const std::uint32_t> sides) {
    const std::uint32_t low = edge_at(mesh.triangles, sides[0]).first;
    int balance = 0;
    for (const std::uint32_t side : sides) balance += vertex_at(mesh.triangles, side) == low ? 1 : -1;
    if (balance != 0) closed[components.of_triangle[sides[0] / 3]] = 0;
  });
  return closed;
}

int turn_inside_out_components(TriangleMesh& mesh, int& count) {
  const Components components = find_components(mesh);
  count = static_cast<int>(components.count);
  std::vector<ComponentShape> shapes = measure(mesh, components);
  // A component so thin that rounding decides its sign has no inside.
  const auto is_negative = [](const ComponentShape& shape) {
    return shape.six_volumes < -1e-9 * std::pow(shape.double_area, 1.5);
  };
  if (std::none_of(shapes.begin(), shapes.end(), is_negative)) return 0;
  const std::vector<std::uint8_t> closed = closed_components(mesh, components);
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) shapes[components.of_triangle[i]].triangles.push_back(i);

  const auto is_inside = [&](const ComponentShape& inner, const ComponentShape& outer) {
    const bool may_be = (inner.box.lowest.array() > outer.box.lowest.array()).all() &&
                        (inner.box.highest.array() < outer.box.highest.array()).all();
    return may_be && std::abs(winding_number(mesh, outer.triangles, inner.origin)) > 0.5;
  };
  const auto is_inside_another = [&](const ComponentShape& inner) {
    for (std::size_t i = 0; i < shapes.size(); ++i)
      if (closed[i] != 0 && is_inside(inner, shapes[i])) return true;
    return false;
  };
  std::vector<bool> turned(components.count, false);
  for (std::size_t i = 0; i < shapes.size(); ++i)
    turned[i] = closed[i] != 0 && is_negative(shapes[i]) && !is_inside_another(shapes[i]);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (turned[components.of_triangle[i]]) std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
  return static_cast<int>(std::count(turned.begin(), turned.end(), true));
}

}  // namespace kiln
