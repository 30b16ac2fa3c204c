// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "mesh/triangle_mesh.h"

/// Generated meshes for tests.
namespace kiln::shapes {

/// Makes a square of `cells` x `cells` x 2 triangles in the plane y = `height`, from -side/2 to side/2 along x and z,
/// facing +Y. One chart: +u along +x, +v along -z, `margin` of the atlas free at each border.
inline TriangleMesh plane(int cells, float side = 1, float height = 0, float margin = 0.1f) {
  TriangleMesh mesh;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const float s = static_cast<float>(i) / static_cast<float>(cells),
                  t = static_cast<float>(j) / static_cast<float>(cells);
      mesh.positions.emplace_back((s - 0.5f) * side, height, (0.5f - t) * side);
      mesh.normals.push_back(Eigen::Vector3f::UnitY());
      mesh.uvs.emplace_back(margin + (1 - 2 * margin) * s, margin + (1 - 2 * margin) * t);
    }
  const auto vertex = [&](int i, int j) { return static_cast<std::uint32_t>(j * (cells + 1) + i); };
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  return mesh;
}

/// Makes a sphere about the origin: an icosahedron whose triangles are cut into four `levels` times. Normals, no uvs.
inline TriangleMesh icosphere(int levels, float radius = 1) {
  TriangleMesh mesh;
  const float golden = 1.6180339887f;
  for (int axis = 0; axis < 3; ++axis)
    for (const float a : {-1.0f, 1.0f})
      for (const float b : {-golden, golden}) {
        Eigen::Vector3f p = Eigen::Vector3f::Zero();
        p[(axis + 1) % 3] = a;
        p[(axis + 2) % 3] = b;
        mesh.positions.push_back(p.normalized());
      }
  // Makes faces of the twelve vertices: any three that are an edge's length apart from each other.
  const float edge = 2 / std::sqrt(1 + golden * golden) * 1.01f;
  const auto near = [&](std::uint32_t a, std::uint32_t b) {
    return (mesh.positions[a] - mesh.positions[b]).norm() < edge;
  };
  for (std::uint32_t a = 0; a < 12; ++a)
    for (std::uint32_t b = a + 1; b < 12; ++b)
      for (std::uint32_t c = b + 1; c < 12; ++c) {
        if (!near(a, b) || !near(b, c) || !near(a, c)) continue;
        const Eigen::Vector3f& p = mesh.positions[a];
        const bool outwards = (mesh.positions[b] - p).cross(mesh.positions[c] - p).dot(p) > 0;
        mesh.triangles.push_back(outwards ? Triangle{a, b, c} : Triangle{a, c, b});
      }
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [found, added] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.positions.size()));
      if (added) mesh.positions.push_back((mesh.positions[a] + mesh.positions[b]).normalized());
      return found->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.push_back({a, ab, ca});
      finer.push_back({ab, b, bc});
      finer.push_back({ca, bc, c});
      finer.push_back({ab, bc, ca});
    }
    mesh.triangles = std::move(finer);
  }
  mesh.normals = mesh.positions;
  for (Eigen::Vector3f& p : mesh.positions) p *= radius;
  return mesh;
}

/// Makes a sphere about the origin from a cube's six sides, each of `cells` x `cells` x 2 triangles and one chart of
/// its own in a 3 x 2 grid, with `margin` of the atlas free around it. Vertices are split at the charts' borders;
/// normals are the sphere's.
inline TriangleMesh cube_sphere(int cells, float radius = 1, float margin = 0.02f) {
  TriangleMesh mesh;
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2;
    const float sign = side % 2 == 0 ? 1.0f : -1.0f;
    Eigen::Vector3f out = Eigen::Vector3f::Zero(), along_u = Eigen::Vector3f::Zero();
    out[axis] = sign;
    along_u[(axis + 1) % 3] = 1;
    const Eigen::Vector3f along_v = out.cross(along_u);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int j = 0; j <= cells; ++j)
      for (int i = 0; i <= cells; ++i) {
        const float s = static_cast<float>(i) / static_cast<float>(cells),
                    t = static_cast<float>(j) / static_cast<float>(cells);
        const Eigen::Vector3f direction = (out + (2 * s - 1) * along_u + (2 * t - 1) * along_v).normalized();
        mesh.positions.push_back(radius * direction);
        mesh.normals.push_back(direction);
        mesh.uvs.emplace_back((static_cast<float>(side % 3) + margin * 3 + (1 - margin * 6) * s) / 3,
                              (static_cast<float>(side / 3) + margin * 2 + (1 - margin * 4) * t) / 2);
      }
    const auto vertex = [&](int i, int j) { return first + static_cast<std::uint32_t>(j * (cells + 1) + i); };
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i) {
        mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
        mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
      }
  }
  return mesh;
}

/// Makes a closed cube from -0.5 to 0.5, each side of `cells` x `cells` x 2 triangles, vertices shared. No normals, no
/// uvs.
inline TriangleMesh cube(int cells) {
  TriangleMesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> at_place;
  const auto vertex = [&](const std::array<int, 3>& place) {
    const auto [found, added] = at_place.try_emplace(place, static_cast<std::uint32_t>(mesh.positions.size()));
    if (added) {
      const Eigen::Vector3f steps(static_cast<float>(place[0]), static_cast<float>(place[1]),
                                  static_cast<float>(place[2]));
      mesh.positions.push_back(steps / static_cast<float>(cells) - Eigen::Vector3f::Constant(0.5f));
    }
    return found->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const bool far : {false, true})
      for (int j = 0; j < cells; ++j)
        for (int i = 0; i < cells; ++i) {
          const auto corner = [&](int di, int dj) {
            std::array<int, 3> place;
            place[axis] = far ? cells : 0;
            place[(axis + 1) % 3] = i + di;
            place[(axis + 2) % 3] = j + dj;
            return vertex(place);
          };
          const std::uint32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          mesh.triangles.push_back(far ? Triangle{a, b, c} : Triangle{a, c, b});
          mesh.triangles.push_back(far ? Triangle{a, c, d} : Triangle{a, d, c});
        }
  return mesh;
}

/// Makes an open sheet of `cells` x `cells` x 2 triangles about the unit square of the xz plane, facing +Y, with a hill
/// in the middle and a border of `waves` sine waves a side, `amplitude` high. No normals, no uvs.
inline TriangleMesh wavy_sheet(int cells, int waves = 3, float amplitude = 0.05f) {
  TriangleMesh mesh = plane(cells);
  mesh.normals.clear();
  mesh.uvs.clear();
  const float pi = 3.14159265f;
  for (Eigen::Vector3f& p : mesh.positions) {
    const float x = p.x(), z = p.z();
    const auto wave = [&](float along) { return amplitude * std::sin(2 * pi * static_cast<float>(waves) * along); };
    p.x() += 2 * x * wave(z + 0.5f);
    p.z() += 2 * z * wave(x + 0.5f);
    p.y() = 0.1f * std::cos(pi * x) * std::cos(pi * z);
  }
  return mesh;
}

/// Makes a patch of a cylinder of radius 1 about the y axis, `height` high, covering `angle` radians, facing outwards.
/// Mesh without normals and uvs.
inline TriangleMesh cylinder_patch(int cells, float height, float angle) {
  TriangleMesh mesh = plane(cells);
  mesh.normals.clear();
  mesh.uvs.clear();
  for (Eigen::Vector3f& p : mesh.positions) {
    const float around = angle * p.x(), up = -height * p.z();
    p = {std::sin(around), up, std::cos(around)};
  }
  return mesh;
}

/// Makes a torus about the y axis, `cells` x `cells` x 2 triangles: genus 1, closed. No normals, no uvs.
inline TriangleMesh torus(int cells, float radius = 1, float tube_radius = 0.4f) {
  TriangleMesh mesh;
  const float step = 2 * 3.14159265f / static_cast<float>(cells);
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const float around = step * static_cast<float>(i), about = step * static_cast<float>(j);
      const float distance = radius + tube_radius * std::cos(about);
      mesh.positions.emplace_back(distance * std::sin(around), tube_radius * std::sin(about),
                                  distance * std::cos(around));
    }
  const auto vertex = [&](int i, int j) { return static_cast<std::uint32_t>(j % cells * cells + i % cells); };
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  return mesh;
}

/// Joins both meshes' positions and triangles, the second mesh moved; other attributes are dropped.
inline TriangleMesh joined(const TriangleMesh& first, const TriangleMesh& second, const Eigen::Vector3f& move) {
  TriangleMesh mesh;
  mesh.positions = first.positions;
  mesh.triangles = first.triangles;
  const auto offset = static_cast<std::uint32_t>(first.positions.size());
  for (const Eigen::Vector3f& p : second.positions) mesh.positions.push_back(p + move);
  for (const Triangle& t : second.triangles) mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return mesh;
}

}  // namespace kiln::shapes
