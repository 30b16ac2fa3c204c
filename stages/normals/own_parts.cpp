// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/own_parts.h"

#include <algorithm>
#include <map>
#include <utility>

#include "mesh/hard_edges.h"
#include "mesh/mesh_components.h"
#include "mesh/same_position.h"
#include "normals/part_scene.h"

namespace kiln {

namespace {

/// Returns, for each part of the low mesh, the part of the high mesh that most of its texels stand for.
std::vector<std::uint32_t> most_voted(const Components& low, const Components& high, const UvRaster& raster,
                                      const std::vector<std::uint32_t>& triangles) {
  std::vector<std::map<std::uint32_t, std::size_t>> votes(low.count);
  for (std::size_t texel = 0; texel < triangles.size(); ++texel)
    if (raster.texels[texel].covered())
      ++votes[low.of_triangle[raster.texels[texel].triangle]][high.of_triangle[triangles[texel]]];
  std::vector<std::uint32_t> own(low.count, 0);
  for (std::size_t part = 0; part < low.count; ++part) {
    std::size_t most = 0;
    for (const auto& [candidate, count] : votes[part]) {
      if (count <= most) continue;
      most = count;
      own[part] = candidate;
    }
  }
  return own;
}

/// Finds the components of a mesh's triangles, none of which goes beyond one of the parts `part_of`.
Components components_within(const TriangleMesh& mesh, const std::vector<std::uint32_t>& part_of) {
  if (part_of.empty()) return find_components(mesh);
  TriangleMesh apart;
  apart.triangles = taken_apart(mesh.triangles, part_of);
  std::uint32_t vertices = 0;
  for (const Triangle& t : apart.triangles) vertices = std::max({vertices, t[0] + 1, t[1] + 1, t[2] + 1});
  apart.positions.resize(vertices);
  return find_components(apart);
}

PartScene scene_of(const TriangleMesh& mesh, const Components& components, std::uint32_t which) {
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    if (components.of_triangle[t] == which) triangles.push_back(t);
  return {mesh, std::move(triangles)};
}

}  // namespace

void keep_to_own_parts(const HighSurface& high, const PointMatcher& matcher, const UvRaster& raster, float farthest,
                       TexelMatches& matches, std::vector<std::uint32_t>& triangles) {
  const TriangleMesh& atlas = matcher.atlas();
  const Components high_parts = components_within(high.mesh, matcher.plan().high_part);
  if (high_parts.count < 2) return;
  const Components low_parts = components_within(join_at_positions(atlas), matcher.plan().low_part);
  const std::vector<std::uint32_t> own = most_voted(low_parts, high_parts, raster, triangles);
  std::map<std::uint32_t, PartScene> scenes;  // only those that are needed
  for (std::size_t texel = 0; texel < triangles.size(); ++texel) {
    const TexelSource& source = raster.texels[texel];
    if (!source.covered()) continue;
    const std::uint32_t part = own[low_parts.of_triangle[source.triangle]];
    if (high_parts.of_triangle[triangles[texel]] == part) continue;
    auto scene = scenes.find(part);
    if (scene == scenes.end()) scene = scenes.emplace(part, scene_of(high.mesh, high_parts, part)).first;
    const SurfacePoint point = scene->second.closest_facing_point(interpolate(atlas, atlas.positions, source),
                                                                  interpolate(atlas, atlas.normals, source), farthest);
    if (!point.found()) continue;
    triangles[texel] = point.triangle;
    const auto pixel = [&](Image<float>& image) {
      return Eigen::Map<Eigen::Vector3f>(image.values().data() + 3 * texel);
    };
    pixel(matches.position) = position_at(high.mesh, point);
    pixel(matches.normal_object) = normal_at(high.mesh, point);
    if (!high.albedo.is_constant()) pixel(matches.albedo) = high.albedo.at(point.triangle, point.u, point.v);
    matches.way.values()[texel] = static_cast<std::uint8_t>(TexelWay::nearest_point);
  }
}

}  // namespace kiln
