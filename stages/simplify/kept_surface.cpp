// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/kept_surface.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "base/errors.h"
#include "base/parallel.h"
#include "collapse/uv_layers.h"
#include "import/uv_mesh.h"
#include "mesh/mesh_vertices.h"
#include "mesh/nearest_surface.h"
#include "mesh/triangle_edges.h"

namespace kiln {

namespace {

/// Keeps the triangles of an imported mesh that are in `left`, a part of them in their order, with what they have.
void keep_triangles(ImportedMesh& imported, const std::vector<Triangle>& left) {
  TriangleMesh& mesh = imported.mesh;
  ImportedSurface& surface = imported.surface;
  const auto move_entry = [](auto& values, std::size_t from, std::size_t to) {
    if (!values.empty()) values[to] = values[from];
  };
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size() && count < left.size(); ++t) {
    if (mesh.triangles[t] != left[count]) continue;
    move_entry(mesh.triangles, t, count);
    move_entry(mesh.corner_normals, t, count);
    move_entry(surface.uvs, t, count);
    move_entry(surface.material_of, t, count);
    ++count;
  }
  const auto cut = [count](auto& values) {
    if (!values.empty()) values.resize(count);
  };
  cut(mesh.triangles);
  cut(mesh.corner_normals);
  cut(surface.uvs);
  cut(surface.material_of);
}

/// Splits vertices between triangles of different materials, and sets the materials of vertices.
void split_at_materials(TriangleMesh& mesh, const std::vector<std::uint16_t>& of_triangle, VertexMaterials& materials) {
  std::map<std::pair<std::uint32_t, std::uint16_t>, std::uint32_t> vertex_of;
  std::vector<std::uint32_t> sources;
  materials.of_vertex.clear();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::uint32_t& vertex : mesh.triangles[t]) {
      const auto [found, is_new] =
          vertex_of.try_emplace({vertex, of_triangle[t]}, static_cast<std::uint32_t>(sources.size()));
      if (is_new) {
        sources.push_back(vertex);
        materials.of_vertex.push_back(of_triangle[t]);
      }
      vertex = found->second;
    }
  std::vector<Triangle> triangles = std::move(mesh.triangles);
  mesh = with_vertices(mesh, sources);
  mesh.triangles = std::move(triangles);
}

/// Materials that triangles have, numbered in the file's order, those without one last.
struct UsedMaterials {
  std::vector<std::uint16_t> of_triangle;
  std::vector<std::string> names;
  std::vector<std::uint32_t> pictures;  ///< number of the picture of each, 0 for none
};

UsedMaterials used_materials(const ImportedSurface& surface, std::size_t triangles, const std::string& file) {
  const std::size_t count = surface.materials.size();
  const auto material_of = [&](std::size_t t) {
    const std::int32_t material = surface.material_of.empty() ? -1 : surface.material_of[t];
    return material < 0 ? count : static_cast<std::size_t>(material);
  };
  std::vector<std::uint8_t> is_used(count + 1, 0);
  for (std::size_t t = 0; t < triangles; ++t) is_used[material_of(t)] = 1;
  UsedMaterials used;
  std::vector<std::uint16_t> number(count + 1, 0);
  std::map<std::string, std::uint32_t> pictures;
  for (std::size_t m = 0; m <= count; ++m) {
    if (is_used[m] == 0) continue;
    if (used.names.size() > std::numeric_limits<std::uint16_t>::max())
      throw BadInput(file, fmt::format("has {} materials", count), "65,536 at most",
                     "join some, or leave materials out of --keep");
    number[m] = static_cast<std::uint16_t>(used.names.size());
    used.names.push_back(m < count ? surface.materials[m].name : "");
    used.pictures.push_back(0);
    if (m < count && surface.materials[m].texture)
      used.pictures.back() =
          pictures
              .try_emplace(surface.materials[m].texture->picture.name, static_cast<std::uint32_t>(pictures.size() + 1))
              .first->second;
  }
  for (std::size_t t = 0; t < triangles; ++t) used.of_triangle.push_back(number[material_of(t)]);
  return used;
}

void require_materials(const ImportedSurface& surface) {
  if (surface.materials_fault) throw BadInput(*surface.materials_fault);
}

/// Counts the pictures that the file's materials look up.
std::size_t count_pictures(const ImportedSurface& surface) {
  std::set<std::string> names;
  for (const SourceMaterial& material : surface.materials)
    if (material.texture) names.insert(material.texture->picture.name);
  return names.size();
}

}  // namespace

std::vector<IntegerAttribute> VertexMaterials::attributes() const {
  if (of_vertex.empty()) return {};
  return {{"material", 1, 16, of_vertex, 0}};
}

std::vector<VertexPair> borders_of_materials(const ImportedMesh& imported) {
  require_materials(imported.surface);
  const std::vector<Triangle>& triangles = imported.mesh.triangles;
  const UsedMaterials used = used_materials(imported.surface, triangles.size(), imported.file.string());
  std::vector<VertexPair> borders;
  TriangleEdges(triangles).for_each([&](std::span<const std::uint32_t> sides) {
    if (sides.size() == 2 && used.of_triangle[sides[0] / 3] != used.of_triangle[sides[1] / 3])
      borders.push_back(edge_at(triangles, sides[0]));
  });
  return borders;
}

VertexMaterials take_materials(TriangleMesh& low, const ImportedMesh& imported) {
  const UsedMaterials used = used_materials(imported.surface, imported.mesh.triangles.size(), imported.file.string());
  const NearestSurface surface(imported.mesh);
  constexpr int steps = 4;  // of the points of a triangle along each side
  std::vector<std::uint16_t> of_triangle(low.triangles.size());
  parallel_for(std::size_t{0}, low.triangles.size(), 64, [&](std::size_t t) {
    std::map<std::uint16_t, int> votes;
    std::array<Eigen::Vector3d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = low.positions[low.triangles[t][k]].cast<double>();
    for (int i = 0; i < steps; ++i)
      for (int j = 0; i + j < steps; ++j) {
        const double u = (i + 1.0 / 3) / steps, v = (j + 1.0 / 3) / steps;
        const NearestSurface::Hit hit =
            surface.nearest(corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]));
        ++votes[used.of_triangle[hit.triangle]];
      }
    of_triangle[t] = std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) {
                       return a.second < b.second;
                     })->first;
  });
  VertexMaterials materials{{}, used.names};
  split_at_materials(low, of_triangle, materials);
  return materials;
}

KeptSurface kept_surface(const ImportedMesh& imported, const SimplifySettings& settings) {
  const std::string file = imported.file.string();
  const ImportedSurface& surface = imported.surface;
  if (surface.uvs.empty())
    throw BadInput(file, "has no texture coordinates", "uvs at every corner, since --keep names them",
                   "export them, or leave out uv in --keep");
  if (const std::string fault = fault_of_uvs(surface); !fault.empty())
    throw BadInput(file, fault, "uvs at every corner, since --keep names them",
                   "export them, or leave out uv in --keep");
  if (settings.keeps_materials()) require_materials(surface);

  KeptSurface kept;
  TriangleMesh whole{imported.mesh.positions, imported.mesh.triangles, {}, {}};
  kept.dropped = drop_small_components(whole, settings);
  ImportedMesh left;
  left.mesh = imported.mesh;
  left.mesh.colors.clear();
  left.surface.uvs = surface.uvs;
  left.surface.materials = surface.materials;
  left.surface.material_of = surface.material_of;
  if (kept.dropped.components > 0) keep_triangles(left, whole.triangles);
  kept.mesh = split_at_seams(left);
  std::vector<std::uint32_t> pictures;
  if (settings.keeps_materials()) {
    UsedMaterials used = used_materials(left.surface, left.mesh.triangles.size(), file);
    kept.materials.names = std::move(used.names);
    split_at_materials(kept.mesh, used.of_triangle, kept.materials);
    for (const std::uint16_t material : kept.materials.of_vertex) pictures.push_back(used.pictures[material]);
  } else if (const std::size_t count = count_pictures(surface); count > 1) {
    kept.warnings.push_back(fmt::format(
        "{}: has {} textures, whose borders are not kept; give --keep uv,materials to keep them", file, count));
  }
  kept.layers = find_uv_layers(kept.mesh, pictures);
  return kept;
}

}  // namespace kiln
