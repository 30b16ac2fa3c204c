// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/imported_normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>

#include "base/errors.h"
#include "import/text_lines.h"
#include "mesh/hard_edges.h"
#include "mesh/mesh_components.h"
#include "mesh/surface_point.h"
#include "mesh/triangle_edges.h"

namespace kiln {

namespace {

using CornerNormals = std::vector<std::array<Eigen::Vector3f, 3>>;

/// Makes the winding of each component and the normals of its corners agree. Returns how many triangles were turned,
/// and how many have turned normals.
struct Turned {
  int triangles = 0, normals = 0;
};
Turned agree(TriangleMesh& mesh, CornerNormals& normals) {
  const Components components = find_components(mesh);
  std::vector<double> agreeing(components.count, 0);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corners = mesh.triangles[t];
    const Eigen::Vector3f a = mesh.positions[corners[0]];
    const Eigen::Vector3f area = (mesh.positions[corners[1]] - a).cross(mesh.positions[corners[2]] - a);
    for (const Eigen::Vector3f& normal : normals[t])
      if (normal.allFinite()) agreeing[components.of_triangle[t]] += area.dot(normal);
  }
  Turned turned;
  if (std::none_of(agreeing.begin(), agreeing.end(), [](double sum) { return sum < 0; })) return turned;
  const std::vector<std::uint8_t> closed = closed_components(mesh, components);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t component = components.of_triangle[t];
    if (!(agreeing[component] < 0)) continue;
    if (closed[component] != 0) {
      for (Eigen::Vector3f& normal : normals[t]) normal = -normal;
      ++turned.normals;
    } else {
      std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
      std::swap(normals[t][1], normals[t][2]);
      ++turned.triangles;
    }
  }
  return turned;
}

/// Replaces corner normals that are not believable by the normal of the faces around. Returns how many there were.
int replace_unbelievable(const TriangleMesh& smooth, CornerNormals& normals) {
  int replaced = 0;
  for (std::uint32_t t = 0; t < normals.size(); ++t) {
    const Eigen::Vector3f face = face_normal(smooth, t);
    for (std::size_t k = 0; k < 3; ++k) {
      Eigen::Vector3f& normal = normals[t][k];
      const float length = normal.norm();
      if (length > 1e-6f && std::isfinite(length) && normal.dot(face) > 0) {
        normal /= length;
        continue;
      }
      const Eigen::Vector3f& around = smooth.normals[smooth.triangles[t][k]];
      normal = around.dot(face) > 0 ? around : face;
      ++replaced;
    }
  }
  return replaced;
}

/// Tells whether all corners have the normals of their faces, and these differ little from one to the next: the output
/// of programs that do not know smooth surfaces.
bool is_facetted(const TriangleMesh& mesh) {
  if (mesh.corner_normals.empty()) return false;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (const Eigen::Vector3f& normal : mesh.corner_normals[t])
      if (normal.dot(face_normal(mesh, t)) < 0.9995f) return false;
  const std::size_t all = hard_edges_by_angle(mesh, 0.5).size(), sharp = hard_edges_by_angle(mesh, 25).size();
  return all > 100 && sharp < all / 4;
}

void take_file_normals(TriangleMesh& mesh, const CornerAttributes& attributes, std::vector<std::string>& warnings) {
  CornerNormals normals = attributes.normals();
  const auto add = [&](int count, const std::string& what, const std::string& rest) {
    if (count > 0) warnings.push_back(counted(static_cast<std::uint64_t>(count), what) + " " + rest);
  };
  const Turned turned = agree(mesh, normals);
  add(turned.triangles, "triangle",
      "of open parts wound against the file's normals, turned to face them; --normals smooth keeps the winding");
  add(turned.normals, "triangle", "of closed parts with normals in the file that point inwards; these are turned");
  compute_vertex_normals(mesh);
  add(replace_unbelievable(mesh, normals), "corner",
      "without a normal in the file, or with one that faces away from its triangle; it has that of the faces around");
  mesh.corner_normals = std::move(normals);
  if (is_facetted(mesh))
    warnings.emplace_back(
        "the file's normals are those of its triangles, so that the surface is shaded flat; --normals smooth or "
        "--normals angle:40 shades it smoothly");
  average_corner_normals(mesh);
}

}  // namespace

void set_normals(TriangleMesh& mesh, const CornerAttributes& attributes, const NormalChoice& choice,
                 const std::string& name, std::vector<std::string>& warnings) {
  using Kind = NormalChoice::Kind;
  if (choice.kind == Kind::file && !attributes.has_normals())
    throw BadInput(name, "has no normals", "a file with normals, as --normals file asks for",
                   "export them, or leave --normals out");
  const bool asks_file = choice.kind != Kind::smooth;
  if (choice.kind == Kind::angle) {
    compute_normals_between(mesh, hard_edges_by_angle(mesh, choice.degrees));
  } else if (asks_file && attributes.has_normals()) {
    take_file_normals(mesh, attributes, warnings);
  } else if (asks_file && attributes.has_smoothing_groups()) {
    compute_normals_between(mesh, hard_edges_of_groups(mesh, attributes.smoothing_groups()));
  } else {
    compute_vertex_normals(mesh);
  }
}

}  // namespace kiln
