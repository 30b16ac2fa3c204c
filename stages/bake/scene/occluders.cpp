// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/scene/occluders.h"

#include <algorithm>
#include <utility>

#include "mesh/convex_hull.h"
#include "mesh/hard_edges.h"

namespace kiln {

namespace {

/// Sets the corner normals of the whole if one of its parts has them; other parts get those of their creases.
void join_corner_normals(const std::vector<TriangleMesh>& parts, TriangleMesh& whole) {
  constexpr double crease_degrees = 45;  // as a surface cache has it for meshes without hard edges
  if (std::all_of(parts.begin(), parts.end(), [](const TriangleMesh& part) { return part.corner_normals.empty(); }))
    return;
  for (const TriangleMesh& part : parts) {
    TriangleMesh shaded = part;
    if (shaded.corner_normals.empty()) compute_normals_between(shaded, hard_edges_by_angle(shaded, crease_degrees));
    for (std::uint32_t t = 0; t < shaded.triangles.size(); ++t)
      whole.corner_normals.push_back(
          {corner_normal(shaded, t, 0), corner_normal(shaded, t, 1), corner_normal(shaded, t, 2)});
    whole.normals.insert(whole.normals.end(), shaded.normals.begin(), shaded.normals.end());
  }
}

}  // namespace

std::vector<Triangle> enclosing_triangles(const Occluders& occluders) {
  if (occluders.sheets.empty()) return occluders.mesh.triangles;
  std::vector<Triangle> triangles;
  for (std::size_t t = 0; t < occluders.sheets.size(); ++t)
    if (occluders.sheets[t] == 0) triangles.push_back(occluders.mesh.triangles[t]);
  return triangles;
}

Occluders join_occluders(const std::vector<TriangleMesh>& meshes, std::vector<SurfaceAlbedo> albedos) {
  Occluders joined;
  joined.closed = std::all_of(meshes.begin(), meshes.end(), is_closed);
  for (const TriangleMesh& mesh : meshes) joined.add(mesh);
  joined.albedos = std::move(albedos);
  join_corner_normals(meshes, joined.mesh);
  joined.hull = hull_corners(joined.mesh);
  return joined;
}

}  // namespace kiln
