// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <tuple>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Writes a mesh as an OBJ file for other programs: vertices at the same position become one, so that seams of an atlas
/// are no borders; uvs, if there are any, belong to corners, and so do normals, if they are asked for.
inline void write_peer_obj(const std::filesystem::path& file, const TriangleMesh& mesh, bool with_normals = false) {
  std::ofstream out(file);
  out.precision(9);
  std::map<std::tuple<float, float, float>, std::size_t> numbers;
  std::vector<std::size_t> number;
  for (const Eigen::Vector3f& p : mesh.positions) {
    const auto [place, is_new] = numbers.try_emplace({p.x(), p.y(), p.z()}, numbers.size() + 1);
    number.push_back(place->second);
    if (is_new) out << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  }
  for (const Eigen::Vector2f& uv : mesh.uvs) out << "vt " << uv.x() << ' ' << uv.y() << '\n';
  std::size_t normals = 0;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    for (std::size_t k = 0; with_normals && k < 3; ++k) {
      const Eigen::Vector3f& n = corner_normal(mesh, i, k);
      out << "vn " << n.x() << ' ' << n.y() << ' ' << n.z() << '\n';
    }
    out << 'f';
    for (const std::uint32_t vertex : t) {
      out << ' ' << number[vertex];
      if (!mesh.uvs.empty() || with_normals) out << '/';
      if (!mesh.uvs.empty()) out << vertex + 1;
      if (with_normals) out << '/' << ++normals;
    }
    out << '\n';
  }
}

}  // namespace kiln
