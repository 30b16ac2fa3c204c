// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "shapes.h"

/// Generated meshes that are hard for simplifiers.
namespace kiln::shapes {

/// Makes a closed surface about the y axis: `around` points on each of `rings` rings, from the lowest to the highest of
/// the outside, with a point at either end. at(ring, angle) is a point; faces outwards if rings go upwards.
inline TriangleMesh turned(int around, int rings, const Eigen::Vector3f& first, const Eigen::Vector3f& last,
                           const std::function<Eigen::Vector3f(int, float)>& at) {
  TriangleMesh mesh;
  const auto vertex = [&](int ring, int i) { return static_cast<std::uint32_t>(ring * around + i % around); };
  for (int ring = 0; ring < rings; ++ring)
    for (int i = 0; i < around; ++i)
      mesh.positions.push_back(
          at(ring, 2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(around)));
  const auto low = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.push_back(first);
  mesh.positions.push_back(last);
  for (int i = 0; i < around; ++i) {
    mesh.triangles.push_back({low, vertex(0, i + 1), vertex(0, i)});
    for (int ring = 0; ring + 1 < rings; ++ring) {
      mesh.triangles.push_back({vertex(ring, i), vertex(ring, i + 1), vertex(ring + 1, i + 1)});
      mesh.triangles.push_back({vertex(ring, i), vertex(ring + 1, i + 1), vertex(ring + 1, i)});
    }
    mesh.triangles.push_back({low + 1, vertex(rings - 1, i), vertex(rings - 1, i + 1)});
  }
  return mesh;
}

/// Makes a closed bowl of radius 1, open upwards, with a wall of thickness `wall`.
inline TriangleMesh thin_bowl(int around, int rings, float wall) {
  const auto at = [&](int ring, float angle) {
    const bool outside = ring < rings;
    const int row = outside ? ring : 2 * rings - 1 - ring;
    const float radius = outside ? 1 : 1 - wall;
    const float down = 0.5f * std::numbers::pi_v<float> * static_cast<float>(row + 1) / static_cast<float>(rings);
    return Eigen::Vector3f(radius * std::sin(down) * std::cos(angle), -radius * std::cos(down),
                           -radius * std::sin(down) * std::sin(angle));
  };
  return turned(around, 2 * rings, {0, -1, 0}, {0, wall - 1, 0}, at);
}

/// Makes a gear of radius 1 with `teeth` teeth and chamfers.
inline TriangleMesh gear(int teeth, int around_tooth) {
  constexpr float heights[] = {-0.2f, -0.2f, -0.2f, -0.15f, -0.05f, 0.05f, 0.15f, 0.2f, 0.2f, 0.2f};
  constexpr float shares[] = {0.3f, 0.6f, 0.95f, 1, 1, 1, 1, 0.95f, 0.6f, 0.3f};
  const auto at = [&](int ring, float angle) {
    const float phase = angle * static_cast<float>(teeth) / (2 * std::numbers::pi_v<float>);
    const float in_tooth = phase - std::floor(phase);
    const float rise = std::clamp(8 * std::min(in_tooth, 1 - in_tooth) - 1, 0.0f, 1.0f);
    const float radius = shares[ring] * (0.85f + 0.15f * rise);
    return Eigen::Vector3f(radius * std::cos(angle), heights[ring], -radius * std::sin(angle));
  };
  return turned(teeth * around_tooth, 10, {0, -0.2f, 0}, {0, 0.2f, 0}, at);
}

/// Makes a closed box from -0.5 to 0.5 with slivers of height `thin`, one at every edge of its triangles, as CSG leaves
/// them.
inline TriangleMesh box_with_slivers(int cells, float thin) {
  TriangleMesh mesh = cube(cells);
  const std::vector<Triangle> whole = mesh.triangles;
  mesh.triangles.clear();
  const auto sides_at = [&](std::uint32_t vertex) {
    return (mesh.positions[vertex].cwiseAbs().array() > 0.499f).count();
  };
  for (const Triangle& t : whole) {
    int split = -1;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3f edge = mesh.positions[t[(k + 1) % 3]] - mesh.positions[t[k]];
      const bool along = (edge.array().abs() > 1e-6f).count() == 1;
      if (along && sides_at(t[k]) >= 2 && sides_at(t[(k + 1) % 3]) >= 2) split = k;
    }
    if (split < 0) {
      mesh.triangles.push_back(t);
      continue;
    }
    const std::uint32_t a = t[split], b = t[(split + 1) % 3], c = t[(split + 2) % 3];
    const Eigen::Vector3f middle = (mesh.positions[a] + mesh.positions[b]) / 2;
    const Eigen::Vector3f inwards = (mesh.positions[c] - middle).normalized();
    const auto m = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.push_back(middle + thin * inwards);
    for (const Triangle& part : {Triangle{a, b, m}, {a, m, c}, {m, b, c}}) mesh.triangles.push_back(part);
  }
  return mesh;
}

/// Returns a number of 0 to 1 from a linear congruential generator [Press].
inline float next_random(std::uint32_t& state) {
  state = state * 1664525u + 1013904223u;
  return static_cast<float>(state >> 8) / static_cast<float>(1 << 24);
}

inline TriangleMesh scaled(TriangleMesh mesh, const Eigen::Vector3f& factors) {
  for (Eigen::Vector3f& p : mesh.positions) p = p.cwiseProduct(factors);
  mesh.normals.clear();
  return mesh;
}

/// Adds to `mesh` `count` cubes of `size`, strewn over a box of twice its extent.
inline TriangleMesh with_specks(TriangleMesh mesh, int count, float size) {
  const BoundingBox box = bounding_box(mesh);
  const TriangleMesh speck = scaled(cube(1), Eigen::Vector3f::Constant(size));
  std::uint32_t state = 7;
  for (int i = 0; i < count; ++i) {
    Eigen::Vector3f place;
    for (float& x : place) x = 2 * next_random(state) - 1;
    mesh = joined(mesh, speck, box.centre() + place.cwiseProduct(box.highest - box.lowest));
  }
  return mesh;
}

/// Makes `parts` ellipsoids that intersect along a bent line, as characters are assembled.
inline TriangleMesh character(int parts, int levels) {
  TriangleMesh mesh;
  std::uint32_t state = 3;
  for (int i = 0; i < parts; ++i) {
    Eigen::Vector3f radii;
    for (float& r : radii) r = 0.08f + 0.25f * next_random(state);
    const float along = static_cast<float>(i) / static_cast<float>(parts);
    const Eigen::Vector3f place(0.6f * std::sin(9 * along), 3 * along, 0.6f * std::cos(7 * along));
    mesh = joined(mesh, scaled(icosphere(levels), radii), place);
  }
  return mesh;
}

}  // namespace kiln::shapes
