// SPDX-License-Identifier: MIT
#include "mesh/hard_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>

#include "mesh/disjoint_sets.h"
#include "mesh/surface_point.h"

namespace kiln {

namespace {

constexpr double radians_per_degree = 3.14159265358979323846 / 180;

/// Edge that two triangles share, and their sides along it, which run in opposite directions.
struct ManifoldEdge {
  EdgeKey key;
  std::uint32_t first, second;
};

/// Finds the shared edges, in the order of their keys. Edges of one triangle, and of more than two, are left out.
std::vector<ManifoldEdge> shared_edges(const TriangleMesh& mesh) {
  std::vector<ManifoldEdge> shared;
  TriangleEdges(mesh.triangles).for_each([&](std::span<const std::uint32_t> sides) {
    if (sides.size() == 2 && run_opposite(mesh.triangles, sides[0], sides[1]))
      shared.push_back({edge_at(mesh.triangles, sides[0]), sides[0], sides[1]});
  });
  return shared;
}

template <class IsHard>
HardEdges edges_where(const TriangleMesh& mesh, const IsHard& is_hard) {
  HardEdges hard;
  for (const ManifoldEdge& edge : shared_edges(mesh))
    if (is_hard(edge)) hard.push_back(edge.key);
  return hard;
}

/// Calls visit(corner, weight, unit face normal) for the corners of triangles with an area; the weight is the angle.
template <class Visit>
void for_each_corner(const TriangleMesh& mesh, const Visit& visit) {
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<Eigen::Vector3d, 3> at;
    for (std::size_t k = 0; k < 3; ++k) at[k] = mesh.positions[mesh.triangles[t][k]].cast<double>();
    const Eigen::Vector3d cross = (at[1] - at[0]).cross(at[2] - at[0]);
    const double length = cross.norm();
    if (!(length > 0)) continue;
    for (std::uint32_t k = 0; k < 3; ++k)
      visit(3 * t + k, std::atan2(length, (at[(k + 1) % 3] - at[k]).dot(at[(k + 2) % 3] - at[k])),
            Eigen::Vector3d(cross / length));
  }
}

Eigen::Vector3f unit_or(const Eigen::Vector3d& sum, const Eigen::Vector3f& otherwise) {
  const double length = sum.norm();
  return length > 1e-12 ? Eigen::Vector3f((sum / length).cast<float>()) : otherwise;
}

}  // namespace

HardEdges hard_edges_by_angle(const TriangleMesh& mesh, double degrees) {
  const double least_cosine = std::cos(degrees * radians_per_degree);
  return edges_where(mesh, [&](const ManifoldEdge& edge) {
    const Eigen::Vector3f a = face_normal(mesh, edge.first / 3), b = face_normal(mesh, edge.second / 3);
    return a.cast<double>().dot(b.cast<double>()) < least_cosine;
  });
}

HardEdges hard_edges_of_normals(const TriangleMesh& mesh, double degrees) {
  if (mesh.corner_normals.empty()) return {};
  const auto least_cosine = static_cast<float>(std::cos(degrees * radians_per_degree));
  const auto normal = [&](std::uint32_t corner) { return corner_normal(mesh, corner / 3, corner % 3); };
  return edges_where(mesh, [&](const ManifoldEdge& edge) {
    return normal(edge.first).dot(normal(next_corner(edge.second))) < least_cosine ||
           normal(next_corner(edge.first)).dot(normal(edge.second)) < least_cosine;
  });
}

HardEdges hard_edges_of_groups(const TriangleMesh& mesh, const std::vector<std::uint32_t>& group_of_triangle) {
  return edges_where(mesh, [&](const ManifoldEdge& edge) {
    const std::uint32_t a = group_of_triangle[edge.first / 3], b = group_of_triangle[edge.second / 3];
    return a != b || a == 0;
  });
}

void compute_normals_between(TriangleMesh& mesh, const HardEdges& hard_edges) {
  if (hard_edges.empty()) return compute_vertex_normals(mesh);
  // Corners that are connected across smooth edges form one sector of their vertex.
  DisjointSets sectors(3 * mesh.triangles.size());
  for (const ManifoldEdge& edge : shared_edges(mesh)) {
    if (std::binary_search(hard_edges.begin(), hard_edges.end(), edge.key)) continue;
    sectors.join(edge.first, next_corner(edge.second));
    sectors.join(next_corner(edge.first), edge.second);
  }
  std::vector<Eigen::Vector3d> sums(3 * mesh.triangles.size(), Eigen::Vector3d::Zero());
  for_each_corner(mesh, [&](std::uint32_t corner, double weight, const Eigen::Vector3d& normal) {
    sums[sectors.root(corner)] += weight * normal;
  });
  mesh.corner_normals.resize(mesh.triangles.size());
  for (std::uint32_t corner = 0; corner < sums.size(); ++corner)
    mesh.corner_normals[corner / 3][corner % 3] = unit_or(sums[sectors.root(corner)], Eigen::Vector3f::UnitY());
  average_corner_normals(mesh);
}

void average_corner_normals(TriangleMesh& mesh, double degrees) {
  std::vector<Eigen::Vector3d> sums(mesh.positions.size(), Eigen::Vector3d::Zero());
  for_each_corner(mesh, [&](std::uint32_t corner, double weight, const Eigen::Vector3d&) {
    sums[vertex_at(mesh.triangles, corner)] += weight * mesh.corner_normals[corner / 3][corner % 3].cast<double>();
  });
  mesh.normals.assign(mesh.positions.size(), Eigen::Vector3f::UnitY());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh.triangles[t][k];
      mesh.normals[vertex] = unit_or(sums[vertex], mesh.corner_normals[t][k]);
    }
  const auto least_cosine = static_cast<float>(std::cos(degrees * radians_per_degree));
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      if (mesh.normals[mesh.triangles[t][k]].dot(mesh.corner_normals[t][k]) < least_cosine) return;
  mesh.corner_normals.clear();
}

TriangleMesh split_at_hard_edges(const TriangleMesh& mesh, std::vector<std::uint32_t>* sources, double degrees) {
  if (mesh.corner_normals.empty()) {
    if (sources != nullptr) {
      sources->resize(mesh.positions.size());
      for (std::uint32_t v = 0; v < sources->size(); ++v) (*sources)[v] = v;
    }
    return mesh;
  }
  const auto least_cosine = static_cast<float>(std::cos(degrees * radians_per_degree));
  constexpr std::uint32_t none = ~0u;
  TriangleMesh split;
  split.frame = mesh.frame;
  split.triangles.resize(mesh.triangles.size());
  std::vector<std::uint32_t> first(mesh.positions.size(), none), further, from;  // a list of copies for each vertex
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh.triangles[t][k];
      const Eigen::Vector3f& normal = mesh.corner_normals[t][k];
      std::uint32_t copy = first[vertex];
      while (copy != none && split.normals[copy].dot(normal) < least_cosine) copy = further[copy];
      if (copy == none) {
        copy = static_cast<std::uint32_t>(from.size());
        from.push_back(vertex);
        further.push_back(first[vertex]);
        first[vertex] = copy;
        split.positions.push_back(mesh.positions[vertex]);
        split.normals.push_back(normal);
        if (!mesh.colors.empty()) split.colors.push_back(mesh.colors[vertex]);
        if (!mesh.uvs.empty()) split.uvs.push_back(mesh.uvs[vertex]);
      }
      split.triangles[t][k] = copy;
    }
  if (sources != nullptr) *sources = std::move(from);
  return split;
}

}  // namespace kiln
