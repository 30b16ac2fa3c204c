// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <span>

#include "mesh/triangle_edges.h"

namespace kiln {

namespace {

/// Lays the triangle down with its first side on the x axis. False where it has no usable area.
bool flatten_triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                      RestTriangle& rest) {
  const double side = (b - a).norm();
  const double longest = std::max({side, (c - b).norm(), (a - c).norm()});
  const double twice_area = (b - a).cross(c - a).norm();
  if (!(twice_area > 1e-6 * longest * longest)) return false;
  rest.corners = {Eigen::Vector2d(0, 0), Eigen::Vector2d(side, 0),
                  Eigen::Vector2d((c - a).dot(b - a) / side, twice_area / side)};
  rest.area = 0.5 * twice_area;
  for (int k = 0; k < 3; ++k) {
    // The gradient is the opposite side turned by 90 degrees, over twice the area.
    const Eigen::Vector2d opposite = rest.corners[(k + 2) % 3] - rest.corners[(k + 1) % 3];
    rest.gradients[k] = Eigen::Vector2d(-opposite.y(), opposite.x()) / twice_area;
  }
  return true;
}

}  // namespace

Surface analyse_surface(const TriangleMesh& mesh) {
  Surface surface;
  surface.mesh = &mesh;
  const auto faces = static_cast<std::uint32_t>(mesh.triangles.size());
  surface.rest.resize(faces);
  surface.face_normals.assign(faces, Eigen::Vector3d::UnitY());
  surface.degenerate.assign(faces, 0);
  surface.edge_lengths.resize(std::size_t{3} * faces);
  surface.twins.assign(std::size_t{3} * faces, no_index);

  for (std::uint32_t f = 0; f < faces; ++f) {
    std::array<Eigen::Vector3d, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = mesh.positions[mesh.triangles[f][k]].cast<double>();
    for (int k = 0; k < 3; ++k) surface.edge_lengths[3 * f + k] = (p[(k + 1) % 3] - p[k]).norm();
    if (!flatten_triangle(p[0], p[1], p[2], surface.rest[f])) {
      surface.degenerate[f] = 1;
      continue;
    }
    surface.face_normals[f] = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
    surface.area += surface.rest[f].area;
  }

  // A proper edge has exactly two half-edges, one each way; faces without area have no part in it.
  TriangleEdges(mesh.triangles).for_each([&](std::span<const std::uint32_t> sides) {
    std::array<std::uint32_t, 2> proper{};
    std::size_t count = 0;
    for (const std::uint32_t h : sides) {
      if (surface.degenerate[h / 3]) continue;
      if (count < 2) proper[count] = h;
      ++count;
    }
    if (count != 2 || !run_opposite(mesh.triangles, proper[0], proper[1])) return;
    surface.twins[proper[0]] = proper[1];
    surface.twins[proper[1]] = proper[0];
  });
  surface.seam_costs = surface.edge_lengths;
  return surface;
}

void weigh_seams(Surface& surface, const std::vector<float>& openness) {
  constexpr double floor = 0.1;  // a seam in the dark still has a cost
  double costs = 0, lengths = 0;
  for (std::uint32_t h = 0; h < surface.half_edge_count(); ++h) {
    const double open =
        0.5 * (static_cast<double>(openness[surface.origin(h)]) + static_cast<double>(openness[surface.target(h)]));
    surface.seam_costs[h] = surface.edge_lengths[h] * (floor + std::clamp(open, 0.0, 1.0));
    costs += surface.seam_costs[h];
    lengths += surface.edge_lengths[h];
  }
  if (!(costs > 0)) return;
  for (double& cost : surface.seam_costs) cost *= lengths / costs;
}

}  // namespace kiln
