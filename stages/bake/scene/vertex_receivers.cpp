// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/scene/vertex_receivers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "base/errors.h"
#include "base/parallel.h"
#include "import/import_mesh.h"
#include "mesh/draco_file.h"
#include "mesh/hard_edges.h"
#include "mesh/morton_order.h"
#include "raycast/ray_scene.h"

namespace kiln {

namespace {

/// Multiple of the vertices' largest distance within which a point that faces as a vertex does is sought: beyond, it is
/// on another part of the object.
constexpr float largest_detour = 4;

/// Least distance of that search, a fraction of the diagonal: positions are quantised to 16 bits.
constexpr float smallest_search = 1e-4f;

/// Lists points and normals, one per vertex, along the curve.
ReceiverSet pack(const std::vector<Eigen::Vector3f>& positions, const std::vector<Eigen::Vector3f>& normals) {
  ReceiverSet receivers{static_cast<int>(positions.size()), 1, {}, {}, {}};
  for (const auto& [code, vertex] : morton_order(positions)) {
    receivers.slots.push_back(vertex);
    receivers.positions.push_back(positions[vertex]);
    receivers.normals.push_back(normals[vertex]);
  }
  return receivers;
}

void check(const TriangleMesh& mesh) {
  if (mesh.positions.empty() || mesh.normals.size() != mesh.positions.size())
    throw std::invalid_argument("vertices as receivers: a mesh with normals is needed");
}

/// Drops triangles with a repeated vertex, then vertices that no triangle uses: Draco keeps neither.
void keep_proper(TriangleMesh& mesh) {
  std::erase_if(mesh.triangles, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  constexpr std::uint32_t unused = ~0u;
  std::vector<std::uint32_t> new_index(mesh.positions.size(), unused);
  for (const Triangle& triangle : mesh.triangles)
    for (std::uint32_t vertex : triangle) new_index[vertex] = 0;
  std::uint32_t kept = 0;
  for (std::uint32_t vertex = 0; vertex < new_index.size(); ++vertex) {
    if (new_index[vertex] == unused) continue;
    mesh.positions[kept] = mesh.positions[vertex];
    mesh.normals[kept] = mesh.normals[vertex];
    if (!mesh.uvs.empty()) mesh.uvs[kept] = mesh.uvs[vertex];
    new_index[vertex] = kept++;
  }
  mesh.positions.resize(kept);
  mesh.normals.resize(kept);
  if (!mesh.uvs.empty()) mesh.uvs.resize(kept);
  for (Triangle& triangle : mesh.triangles)
    for (std::uint32_t& vertex : triangle) vertex = new_index[vertex];
}

template <class Operation>
void for_each_vertex(std::size_t count, const Operation& operation) {
  parallel_for(std::size_t{0}, count, 256, [&](std::size_t k) { operation(k); });
}

}  // namespace

TriangleMesh load_vertex_mesh(const std::filesystem::path& file, const ImportSettings& settings,
                              std::vector<std::string>* warnings) {
  TriangleMesh mesh;
  if (is_draco_file(file)) {
    mesh = load_draco(file);
    if (mesh.normals.empty()) compute_vertex_normals(mesh);
  } else {
    const ImportedMesh imported = import_mesh(file, settings);
    if (warnings != nullptr) warnings->insert(warnings->end(), imported.warnings.begin(), imported.warnings.end());
    mesh = split_at_hard_edges(imported.mesh);
  }
  keep_proper(mesh);
  if (mesh.triangles.empty())
    throw BadInput(file.string(), "has no triangle of three vertices", "a mesh of triangles", "export the mesh again");
  return mesh;
}

VertexReceivers receivers_on_vertices(const TriangleMesh& mesh) {
  check(mesh);
  return {pack(mesh.positions, mesh.normals), 0, 0};
}

VertexReceivers receivers_on_high_of_vertices(const TriangleMesh& mesh, const TriangleMesh& high) {
  check(mesh);
  check(high);
  const RayScene scene(high);
  const std::size_t vertices = mesh.positions.size();

  // Step 1: find the closest points of either side, and with them how far to look.
  std::vector<SurfacePoint> points(vertices);
  for_each_vertex(vertices, [&](std::size_t k) {
    points[k] = scene.closest_point(mesh.positions[k], std::numeric_limits<float>::infinity());
  });
  float farthest = smallest_search * bounding_box(high).diagonal();
  for (const SurfacePoint& point : points) farthest = std::max(farthest, largest_detour * point.distance);

  // Step 2: find the closest points of the right side.
  std::vector<std::uint8_t> away(vertices, 0);
  std::vector<Eigen::Vector3f> positions(vertices), normals(vertices);
  for_each_vertex(vertices, [&](std::size_t k) {
    const SurfacePoint facing = scene.closest_facing_point(mesh.positions[k], mesh.normals[k], farthest);
    away[k] = facing.found() ? 0 : 1;
    if (facing.found()) points[k] = facing;
    positions[k] = position_at(high, points[k]);
    normals[k] = normal_at(high, points[k]);
  });

  VertexReceivers result{pack(positions, normals), 0, 0};
  for (std::size_t k = 0; k < vertices; ++k) {
    result.largest_distance = std::max(result.largest_distance, static_cast<double>(points[k].distance));
    result.facing_away += away[k];
  }
  return result;
}

}  // namespace kiln
