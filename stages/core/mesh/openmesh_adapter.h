#pragma once

// This header alone shows CGAL and OpenMesh, and is for .cpp files only. OpenMesh's names must be seen before CGAL's
// algorithms.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/boost/graph/Euler_operations.h>
#include <CGAL/boost/graph/graph_traits_TriMesh_ArrayKernelT.h>
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <array>
#include <stdexcept>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

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

/// Converts a mesh; vertices and faces keep their order and indices. The triangles must be an oriented manifold: throws
/// std::invalid_argument otherwise.
inline HalfedgeMesh to_halfedges(const TriangleMesh& mesh) {
  HalfedgeMesh result;
  result.reserve(mesh.positions.size(), mesh.triangles.size() * 3 / 2, mesh.triangles.size());
  for (const Eigen::Vector3f& p : mesh.positions) result.add_vertex(HalfedgeMesh::Point(p.x(), p.y(), p.z()));
  // Add faces through CGAL, which attaches them to whatever is there already; OpenMesh refuses some orders of a
  // manifold's faces.
  std::array<HalfedgeMesh::VertexHandle, 3> corners;
  for (const Triangle& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) corners[i] = HalfedgeMesh::VertexHandle(static_cast<int>(triangle[i]));
    if (!CGAL::Euler::add_face(corners, result).is_valid())
      throw std::invalid_argument("to_halfedges: the triangles are no oriented manifold");
  }
  return result;
}

}  // namespace kiln
