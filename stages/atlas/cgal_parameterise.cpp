// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/cgal_parameterise.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_parameterization/ARAP_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/LSCM_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Mean_value_coordinates_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/parameterize.h>
#include <limits>

namespace kiln {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
namespace smp = CGAL::Surface_mesh_parameterization;
using Border = smp::Circular_border_arc_length_parameterizer_3<Mesh>;

}  // namespace

std::vector<Eigen::Vector2d> cgal_parameterise(const Surface& surface, const Chart& chart,
                                               Parameteriser parameteriser) {
  Mesh mesh;
  for (const std::uint32_t vertex : chart.vertices) {
    const Eigen::Vector3f& p = surface.mesh->positions[vertex];
    mesh.add_vertex(Kernel::Point_3(p.x(), p.y(), p.z()));
  }
  for (const Triangle& t : chart.triangles)
    if (mesh.add_face(Mesh::Vertex_index(t[0]), Mesh::Vertex_index(t[1]), Mesh::Vertex_index(t[2])) ==
        Mesh::null_face())
      return {};
  const auto border = CGAL::Polygon_mesh_processing::longest_border(mesh).first;
  if (border == Mesh::null_halfedge()) return {};

  auto map = mesh.add_property_map<Mesh::Vertex_index, Kernel::Point_2>("v:uv", Kernel::Point_2(0, 0)).first;
  smp::Error_code status = smp::ERROR_EMPTY_MESH;
  try {
    switch (parameteriser) {
      case Parameteriser::lscm:
        status = smp::parameterize(mesh, smp::LSCM_parameterizer_3<Mesh>(), border, map);
        break;
      case Parameteriser::arap:
        status = smp::parameterize(mesh, smp::ARAP_parameterizer_3<Mesh>(), border, map);
        break;
      case Parameteriser::mean_value:
        status = smp::parameterize(mesh, smp::Mean_value_coordinates_parameterizer_3<Mesh, Border>(), border, map);
        break;
      case Parameteriser::unfolded:
        break;
    }
  } catch (const std::exception&) {
    return {};  // a failed precondition inside CGAL: another way must do
  }
  if (status != smp::OK) return {};
  std::vector<Eigen::Vector2d> uvs;
  for (const Mesh::Vertex_index v : mesh.vertices()) uvs.emplace_back(map[v].x(), map[v].y());
  return uvs;
}

}  // namespace kiln
