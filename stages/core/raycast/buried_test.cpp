// SPDX-License-Identifier: GPL-3.0-or-later
#include "raycast/buried_test.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <utility>

#include "base/parallel.h"
#include "mesh/hard_edges.h"
#include "mesh/mesh_components.h"
#include "mesh/same_position.h"
#include "raycast/embree_scene.h"
#include "sh/directions.h"

namespace kiln {

namespace {

/// Rays that are cast in search of light, spread over all directions: a point is seen if one of them is free.
constexpr int light_directions = 32;

/// Least sine of the angle between a surface and a ray that leaves it, for the ray to count.
constexpr float least_cosine = 0.1f;

/// Rays that vote on closed components: the majority is right even if one passes an edge.
constexpr int votes = 3;

/// Rays over which the winding numbers of open components are averaged.
constexpr int winding_directions = 64;

/// Multiple of the ray offset: crossings nearer than this belong to the point's own triangle, if its normal slants.
constexpr float nearest_crossing = 4;

constexpr float largest_open_winding = 0.5f;
constexpr std::size_t chunk_points = 256;

/// Components that a ray crosses, and how often it leaves each minus how often it enters it.
using Crossings = std::vector<std::pair<std::uint32_t, int>>;

struct CrossingContext {
  RTCIntersectContext base;
  Crossings* crossings;
};

void count_crossing(const RTCFilterFunctionNArguments* arguments) {
  const auto& components = *static_cast<const std::vector<std::uint32_t>*>(arguments->geometryUserPtr);
  Crossings& crossings = *reinterpret_cast<const CrossingContext*>(arguments->context)->crossings;
  const auto* ray = reinterpret_cast<const RTCRay*>(arguments->ray);
  const auto* hit = reinterpret_cast<const RTCHit*>(arguments->hit);
  const float outwards = hit->Ng_x * ray->dir_x + hit->Ng_y * ray->dir_y + hit->Ng_z * ray->dir_z;
  const std::uint32_t component = components[hit->primID];
  const auto known = std::find_if(crossings.begin(), crossings.end(),
                                  [&](const auto& crossing) { return crossing.first == component; });
  (known == crossings.end() ? crossings.emplace_back(component, 0) : *known).second += outwards > 0 ? 1 : -1;
  arguments->valid[0] = 0;  // makes the ray go on
}

}  // namespace

struct BuriedTest::Implementation {
  TriangleMesh mesh;
  Components components;
  std::vector<std::uint8_t> closed;  ///< per component
  bool all_closed;
  float ray_offset;
  std::vector<Eigen::Vector3f> light, winding;  ///< directions of rays
  EmbreeScene embree;

  Implementation(TriangleMesh joined, float offset)
      : mesh(std::move(joined)),
        components(find_components(mesh)),
        closed(closed_components(mesh, components)),
        all_closed(std::find(closed.begin(), closed.end(), 0) == closed.end()),
        ray_offset(offset),
        light(sample_directions(Sampling::fibonacci, light_directions, 1)),
        winding(sample_directions(Sampling::fibonacci, winding_directions, 2)),
        embree(mesh.positions, mesh.triangles, count_crossing, &components.of_triangle) {}

  bool is_free(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const;
  Crossings crossings(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float nearest) const;
  bool sees_light(const Eigen::Vector3f& origin, const Eigen::Vector3f& normal) const;
  bool in_closed(const Eigen::Vector3f& origin, const Eigen::Vector3f& normal, float nearest) const;
  bool in_open(const Eigen::Vector3f& origin) const;
  bool is_buried(const Eigen::Vector3f& origin, const Eigen::Vector3f& normal) const;
};

bool BuriedTest::Implementation::is_free(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const {
  RTCRay ray = make_ray(origin, direction);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(embree.scene(), &context, &ray);
  return !(ray.tfar < 0);
}

Crossings BuriedTest::Implementation::crossings(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                                                float nearest) const {
  Crossings found;
  CrossingContext context;
  rtcInitIntersectContext(&context.base);
  context.crossings = &found;
  RTCRayHit query = {};
  query.ray = make_ray(origin, direction, nearest);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(embree.scene(), &context.base, &query);
  return found;
}

bool BuriedTest::Implementation::sees_light(const Eigen::Vector3f& origin, const Eigen::Vector3f& normal) const {
  return std::any_of(light.begin(), light.end(), [&](const Eigen::Vector3f& direction) {
    return direction.dot(normal) > least_cosine && is_free(origin, direction);
  });
}

bool BuriedTest::Implementation::in_closed(const Eigen::Vector3f& origin, const Eigen::Vector3f& normal,
                                           float nearest) const {
  // Takes the rays closest to the normal: they leave the point's own surface at once.
  std::array<Eigen::Vector3f, votes> rays;
  std::partial_sort_copy(
      light.begin(), light.end(), rays.begin(), rays.end(),
      [&](const Eigen::Vector3f& a, const Eigen::Vector3f& b) { return a.dot(normal) > b.dot(normal); });
  int inside = 0;
  for (const Eigen::Vector3f& direction : rays) {
    const Crossings found = crossings(origin, direction, nearest);
    inside += std::any_of(found.begin(), found.end(),
                          [&](const auto& crossing) { return closed[crossing.first] != 0 && crossing.second > 0; });
  }
  return 2 * inside > votes;
}

bool BuriedTest::Implementation::in_open(const Eigen::Vector3f& origin) const {
  std::map<std::uint32_t, int> sums;
  for (const Eigen::Vector3f& direction : winding)
    for (const auto& [component, count] : crossings(origin, direction, 0))
      if (closed[component] == 0) sums[component] += count;
  return std::any_of(sums.begin(), sums.end(), [](const auto& sum) {
    return static_cast<float>(sum.second) > largest_open_winding * winding_directions;
  });
}

bool BuriedTest::Implementation::is_buried(const Eigen::Vector3f& origin, const Eigen::Vector3f& normal) const {
  if (!(normal.squaredNorm() > 0) || is_free(origin, normal)) return false;
  if (in_closed(origin, normal, nearest_crossing * ray_offset)) return true;
  // Undecided so far: open components, and points so close to the limit that only darkness shows on which side they
  // are.
  if (sees_light(origin, normal)) return false;
  return in_closed(origin, normal, 0) || (!all_closed && in_open(origin));
}

BuriedTest::BuriedTest(std::span<const Eigen::Vector3f> positions, std::span<const Triangle> triangles,
                       float ray_offset) {
  if (triangles.empty()) return;
  TriangleMesh mesh;
  mesh.positions.assign(positions.begin(), positions.end());
  mesh.triangles.assign(triangles.begin(), triangles.end());
  implementation_ = std::make_unique<Implementation>(join_at_positions(mesh), ray_offset);
}

BuriedTest::~BuriedTest() = default;

std::vector<std::uint8_t> BuriedTest::operator()(const Receivers& points) const {
  std::vector<std::uint8_t> buried(points.size(), 0);
  if (implementation_ == nullptr) return buried;
  const Implementation& own = *implementation_;
  parallel_for(std::size_t{0}, points.size(), chunk_points, [&](std::size_t k) {
    const Eigen::Vector3f& normal = points.normals[k];
    const Eigen::Vector3f origin = points.positions[k] + own.ray_offset * normal;
    buried[k] = own.is_buried(origin, normal) ? 1 : 0;
  });
  return buried;
}

}  // namespace kiln
