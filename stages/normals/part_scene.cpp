// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/part_scene.h"

#include <unordered_map>
#include <utility>

namespace kiln {

PartScene::PartScene(const TriangleMesh& mesh, std::vector<std::uint32_t> triangles)
    : triangles_(std::move(triangles)), scene_(part_of_mesh(mesh, triangles_)) {}

std::vector<std::vector<std::uint32_t>> listed_by_part(const std::vector<std::uint32_t>& part_of, std::size_t count) {
  std::vector<std::vector<std::uint32_t>> listed(count);
  for (std::uint32_t k = 0; k < part_of.size(); ++k) listed[part_of[k]].push_back(k);
  return listed;
}

std::vector<PartScene> scenes_of_parts(const TriangleMesh& mesh, const std::vector<std::uint32_t>& part_of,
                                       std::size_t count) {
  std::vector<PartScene> scenes;
  if (part_of.empty())
    scenes.emplace_back(mesh);
  else
    for (std::vector<std::uint32_t>& triangles : listed_by_part(part_of, count))
      scenes.emplace_back(mesh, std::move(triangles));
  return scenes;
}

TriangleMesh part_of_mesh(const TriangleMesh& mesh, const std::vector<std::uint32_t>& listed) {
  TriangleMesh part;
  part.frame = mesh.frame;
  part.triangles.reserve(listed.size());
  std::unordered_map<std::uint32_t, std::uint32_t> number_of;
  for (const std::uint32_t t : listed) {
    Triangle& triangle = part.triangles.emplace_back(mesh.triangles[t]);
    for (std::uint32_t& vertex : triangle) {
      const auto [entry, is_new] = number_of.try_emplace(vertex, static_cast<std::uint32_t>(part.positions.size()));
      if (is_new) part.positions.push_back(mesh.positions[vertex]);
      vertex = entry->second;
    }
  }
  return part;
}

std::vector<Triangle> taken_apart(const std::vector<Triangle>& triangles, const std::vector<std::uint32_t>& part_of) {
  if (part_of.empty()) return triangles;
  std::vector<Triangle> apart = triangles;
  std::unordered_map<std::uint64_t, std::uint32_t> number_of;  // key: part and vertex
  for (std::size_t t = 0; t < apart.size(); ++t)
    for (std::uint32_t& vertex : apart[t])
      vertex =
          number_of.try_emplace(std::uint64_t{part_of[t]} << 32 | vertex, static_cast<std::uint32_t>(number_of.size()))
              .first->second;
  return apart;
}

}  // namespace kiln
