// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/scene/buried_receivers.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "base/parallel.h"
#include "mesh/hard_edges.h"
#include "mesh/mesh_components.h"
#include "mesh/same_position.h"
#include "mesh/surface_point.h"
#include "mesh/uv_raster.h"
#include "raycast/buried_test.h"
#include "raycast/ray_scene.h"

namespace kiln {

namespace {

constexpr std::uint32_t no_chart = ~0u;

/// Places that are tried in a texel whose centre is buried: offsets from it in texels, the nearest first.
constexpr std::array<std::array<float, 2>, 16> places = {{{-.125f, -.125f},
                                                          {.125f, -.125f},
                                                          {-.125f, .125f},
                                                          {.125f, .125f},
                                                          {-.375f, -.125f},
                                                          {.375f, -.125f},
                                                          {-.375f, .125f},
                                                          {.375f, .125f},
                                                          {-.125f, -.375f},
                                                          {-.125f, .375f},
                                                          {.125f, -.375f},
                                                          {.125f, .375f},
                                                          {-.375f, -.375f},
                                                          {.375f, -.375f},
                                                          {-.375f, .375f},
                                                          {.375f, .375f}}};

/// Number of places, the outermost and last of the list, that are tried in texels far from any that is not buried.
constexpr std::size_t far_places = 4;

/// Steps on the low mesh from a texel to the next, across and up, object units.
struct TexelSteps {
  Eigen::Vector3f across = Eigen::Vector3f::Zero(), up = Eigen::Vector3f::Zero();

  TexelSteps(const TriangleMesh& atlas, std::uint32_t triangle, int width, int height) {
    const Triangle& t = atlas.triangles[triangle];
    const Eigen::Vector2f size(static_cast<float>(width), static_cast<float>(height));
    const Eigen::Vector2f ab = (atlas.uvs[t[1]] - atlas.uvs[t[0]]).cwiseProduct(size),
                          ac = (atlas.uvs[t[2]] - atlas.uvs[t[0]]).cwiseProduct(size);
    const Eigen::Vector3f b = atlas.positions[t[1]] - atlas.positions[t[0]],
                          c = atlas.positions[t[2]] - atlas.positions[t[0]];
    const float area = ab.x() * ac.y() - ab.y() * ac.x();
    if (area == 0) return;
    across = (ac.y() * b - ab.y() * c) / area;
    up = (ab.x() * c - ac.x() * b) / area;
  }
};

/// Calls visit(neighbour) for the up to 8 texels about one.
template <class Visit>
void for_each_neighbour(std::uint32_t texel, int width, int height, const Visit& visit) {
  const int i = static_cast<int>(texel) % width, j = static_cast<int>(texel) / width;
  for (int y = std::max(j - 1, 0); y <= std::min(j + 1, height - 1); ++y)
    for (int x = std::max(i - 1, 0); x <= std::min(i + 1, width - 1); ++x)
      if (x != i || y != j) visit(static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(width) + x);
}

/// Removes the receivers that are marked in `dropped`; the others stay in order.
void keep_only(ReceiverSet& receivers, const std::vector<std::uint8_t>& dropped) {
  std::size_t kept = 0;
  for (std::size_t r = 0; r < dropped.size(); ++r) {
    if (dropped[r] != 0) continue;
    receivers.slots[kept] = receivers.slots[r];
    receivers.positions[kept] = receivers.positions[r];
    receivers.normals[kept++] = receivers.normals[r];
  }
  receivers.slots.resize(kept);
  receivers.positions.resize(kept);
  receivers.normals.resize(kept);
}

/// Fills `open` places from known ones ring after ring: each from its neighbours that were known before its ring.
/// neighbours_of(place, visit) calls visit with each.
template <class NeighboursOf>
FillPlan plan_fills(std::vector<std::uint32_t> open, std::vector<std::uint8_t> known,
                    const NeighboursOf& neighbours_of) {
  FillPlan plan;
  while (!open.empty()) {
    std::vector<std::uint32_t> left;
    const std::size_t before = plan.texels.size();
    for (const std::uint32_t place : open) {
      const auto first = static_cast<std::uint32_t>(plan.sources.size());
      neighbours_of(place, [&](std::uint32_t neighbour) {
        if (known[neighbour] != 0) plan.sources.push_back(neighbour);
      });
      const auto count = static_cast<std::uint32_t>(plan.sources.size()) - first;
      if (count > 0)
        plan.texels.push_back({place, first, count});
      else
        left.push_back(place);
    }
    if (plan.texels.size() == before) break;  // the rest is in charts that are buried as a whole
    for (std::size_t k = before; k < plan.texels.size(); ++k) known[plan.texels[k].texel] = 1;
    open = std::move(left);
  }
  return plan;
}

/// Moves buried receivers to places in their texels that are not buried, where there are any, and removes their mark.
std::size_t move_to_seen_places(ReceiverSet& receivers, const TriangleMesh& atlas, const UvRaster& raster,
                                const Occluders& occluders, const BuriedTest& is_buried,
                                std::vector<std::uint8_t>& buried) {
  const RayScene surface(occluders.mesh);
  const Components parts = find_components(join_at_positions(occluders.mesh));
  std::vector<std::uint8_t> seen(raster.texels.size(), 0);
  for (std::size_t r = 0; r < buried.size(); ++r) seen[receivers.slots[r]] = buried[r] == 0 ? 1 : 0;

  // Step 1: find the points of the surface that other places of the texels stand for.
  struct Candidate {
    std::uint32_t receiver;
    std::uint8_t place;
  };
  std::vector<Candidate> candidates;
  for (std::uint32_t r = 0; r < buried.size(); ++r) {
    if (buried[r] == 0 || !raster.texels[receivers.slots[r]].covered()) continue;
    bool is_near = false;
    for_each_neighbour(receivers.slots[r], raster.width, raster.height,
                       [&](std::uint32_t neighbour) { is_near = is_near || seen[neighbour] != 0; });
    for (std::size_t k = is_near ? 0 : places.size() - far_places; k < places.size(); ++k)
      candidates.push_back({r, static_cast<std::uint8_t>(k)});
  }
  // Eigen's vectors start with whatever the memory holds, and a ray must not start there.
  const std::size_t count = candidates.size();
  std::vector<Eigen::Vector3f> positions(count, Eigen::Vector3f::Zero()), normals(count, Eigen::Vector3f::UnitY());
  std::vector<std::uint8_t> usable(count, 0);
  parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t k) {
    const auto& [r, place] = candidates[k];
    const TexelSteps steps(atlas, raster.texels[receivers.slots[r]].triangle, raster.width, raster.height);
    const Eigen::Vector3f step = places[place][0] * steps.across + places[place][1] * steps.up;
    const Eigen::Vector3f &from = receivers.positions[r], &normal = receivers.normals[r];
    const float reach = step.norm();
    const SurfacePoint own = surface.closest_facing_point(from, normal, reach);
    const SurfacePoint other = surface.closest_facing_point(from + step, normal, reach);
    if (!own.found() || !other.found()) return;
    if (parts.of_triangle[own.triangle] != parts.of_triangle[other.triangle]) return;
    usable[k] = 1;
    positions[k] = position_at(occluders.mesh, other);
    normals[k] = normal;
  });

  // Step 2: take the first of them that is seen.
  const std::vector<std::uint8_t> is_hidden = is_buried({positions, normals});
  std::size_t moved = 0;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const std::uint32_t r = candidates[k].receiver;
    if (usable[k] == 0 || is_hidden[k] != 0 || buried[r] == 0) continue;
    receivers.positions[r] = positions[k];
    buried[r] = 0;
    ++moved;
  }
  return moved;
}

bool all_of(const std::vector<std::uint8_t>& marks) {
  return std::all_of(marks.begin(), marks.end(), [](std::uint8_t mark) { return mark != 0; });
}

/// Returns the slots of the receivers that are marked, and marks the slots of the `others`.
std::vector<std::uint32_t> places_of(const ReceiverSet& receivers, const std::vector<std::uint8_t>& marks,
                                     std::vector<std::uint8_t>& others) {
  std::vector<std::uint32_t> marked;
  others.assign(static_cast<std::size_t>(receivers.width) * static_cast<std::size_t>(receivers.height), 0);
  for (std::size_t r = 0; r < marks.size(); ++r) {
    if (marks[r] != 0)
      marked.push_back(receivers.slots[r]);
    else
      others[receivers.slots[r]] = 1;
  }
  return marked;
}

}  // namespace

BuriedReport set_aside_buried(ReceiverSet& receivers, const TriangleMesh& atlas, const Occluders& occluders,
                              float ray_offset) {
  const BuriedTest is_buried(occluders.mesh.positions, enclosing_triangles(occluders), ray_offset);
  std::vector<std::uint8_t> buried = is_buried(receivers.view());
  BuriedReport report;
  report.everything = all_of(buried);
  if (report.everything || std::find(buried.begin(), buried.end(), 1) == buried.end()) return report;

  const UvRaster raster = rasterise_uvs(atlas, receivers.width, receivers.height);
  report.moved = move_to_seen_places(receivers, atlas, raster, occluders, is_buried, buried);
  std::vector<std::uint8_t> known;
  std::vector<std::uint32_t> open = places_of(receivers, buried, known);
  report.buried = open.size();
  receivers.buried = open;
  const Components charts = find_components(atlas);
  const auto chart_of = [&](std::uint32_t texel) {
    return raster.texels[texel].covered() ? charts.of_triangle[raster.texels[texel].triangle] : no_chart;
  };
  receivers.fills = plan_fills(std::move(open), std::move(known), [&](std::uint32_t texel, const auto& visit) {
    for_each_neighbour(texel, receivers.width, receivers.height, [&](std::uint32_t neighbour) {
      if (chart_of(neighbour) == chart_of(texel)) visit(neighbour);
    });
  });
  keep_only(receivers, buried);
  return report;
}

BuriedReport set_aside_buried_vertices(ReceiverSet& receivers, const TriangleMesh& mesh, const Occluders& occluders,
                                       float ray_offset) {
  const std::vector<std::uint8_t> buried =
      BuriedTest(occluders.mesh.positions, enclosing_triangles(occluders), ray_offset)(receivers.view());
  BuriedReport report;
  report.everything = all_of(buried);
  if (report.everything || std::find(buried.begin(), buried.end(), 1) == buried.end()) return report;

  std::vector<std::uint8_t> known;
  std::vector<std::uint32_t> open = places_of(receivers, buried, known);
  report.buried = open.size();
  receivers.buried = open;
  std::vector<EdgeKey> edges;  // each edge in both directions
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      edges.emplace_back(t[k], t[(k + 1) % 3]);
      edges.emplace_back(t[(k + 1) % 3], t[k]);
    }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  receivers.fills = plan_fills(std::move(open), std::move(known), [&](std::uint32_t vertex, const auto& visit) {
    for (auto edge = std::lower_bound(edges.begin(), edges.end(), EdgeKey{vertex, 0});
         edge != edges.end() && edge->first == vertex; ++edge)
      visit(edge->second);
  });
  keep_only(receivers, buried);
  return report;
}

}  // namespace kiln
