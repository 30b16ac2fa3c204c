// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Header for cgal_collapse.cpp alone: it shows CGAL and OpenMesh, whose graph traits must be seen before CGAL's
// algorithms.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/boost/graph/Euler_operations.h>
#include <CGAL/boost/graph/graph_traits_TriMesh_ArrayKernelT.h>
#include <CGAL/boost/graph/helpers.h>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <array>
#include <span>
#include <stdexcept>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Traits of OpenMesh: double precision, and the status bits that CGAL needs to remove edges.
struct DoubleTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
  VertexAttributes(OpenMesh::Attributes::Status);
  FaceAttributes(OpenMesh::Attributes::Status);
  EdgeAttributes(OpenMesh::Attributes::Status);
  HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge | OpenMesh::Attributes::Status);
};

/// Half-edge mesh with positions in double precision. CGAL's algorithms take it as a face graph (kernel: Epick).
using HalfedgeMesh = OpenMesh::TriMesh_ArrayKernelT<DoubleTraits>;
using HalfedgeKernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// Property map of a HalfedgeMesh's positions as CGAL points. CGAL's own map for OpenMesh rounds to float what it
/// writes.
struct HalfedgePositions {
  using category = boost::read_write_property_map_tag;
  using key_type = HalfedgeMesh::VertexHandle;
  using value_type = HalfedgeKernel::Point_3;
  using reference = value_type;
  HalfedgeMesh* mesh = nullptr;

  friend value_type get(const HalfedgePositions& map, key_type vertex) {
    const HalfedgeMesh::Point& p = map.mesh->point(vertex);
    return {p[0], p[1], p[2]};
  }
  friend void put(const HalfedgePositions& map, key_type vertex, const value_type& p) {
    map.mesh->set_point(vertex, HalfedgeMesh::Point(p.x(), p.y(), p.z()));
  }
};

/// Builds a HalfedgeMesh of vertices at `positions` and the given triangles, with their indices. Throws
/// std::invalid_argument where the triangles are no oriented manifold.
inline HalfedgeMesh to_halfedges(std::span<const Eigen::Vector3d> positions, std::span<const Triangle> triangles) {
  HalfedgeMesh result;
  result.reserve(positions.size(), triangles.size() * 3 / 2, triangles.size());
  for (const Eigen::Vector3d& p : positions) result.add_vertex(HalfedgeMesh::Point(p.x(), p.y(), p.z()));
  // CGAL joins faces to whatever is there already, where OpenMesh refuses some orders of a manifold's faces.
  std::array<HalfedgeMesh::VertexHandle, 3> corners;
  for (const Triangle& triangle : triangles) {
    for (std::size_t i = 0; i < 3; ++i) corners[i] = HalfedgeMesh::VertexHandle(static_cast<int>(triangle[i]));
    if (!CGAL::Euler::add_face(corners, result).is_valid())
      throw std::invalid_argument("to_halfedges: the triangles are no oriented manifold");
  }
  return result;
}

}  // namespace kiln
