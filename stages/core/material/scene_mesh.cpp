// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/scene_mesh.h"

#include <algorithm>
#include <utility>

namespace kiln {

void SceneMesh::add(const TriangleMesh& part) {
  first_triangles.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
  append(mesh, part);
}

void SceneMesh::add(const TriangleMesh& part, SurfaceAlbedo albedo) {
  add(part);
  albedos.push_back(std::move(albedo));
}

std::size_t SceneMesh::part_of(std::uint32_t triangle) const {
  const auto after = std::upper_bound(first_triangles.begin(), first_triangles.end(), triangle);
  return static_cast<std::size_t>(after - first_triangles.begin()) - 1;
}

Eigen::Vector3f SceneMesh::albedo_at(std::uint32_t triangle, float u, float v) const {
  const std::size_t part = part_of(triangle);
  return albedos[part].at(triangle - first_triangles[part], u, v);
}

bool SceneMesh::is_grey() const {
  return std::all_of(albedos.begin(), albedos.end(), [](const SurfaceAlbedo& albedo) { return albedo.is_grey(); });
}

}  // namespace kiln
