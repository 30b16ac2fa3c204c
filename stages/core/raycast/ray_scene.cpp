// SPDX-License-Identifier: GPL-3.0-or-later
#include "raycast/ray_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "raycast/embree_scene.h"

namespace kiln {

namespace {

/// Least cosine between a direction and the normal of a triangle that faces it: keeps rounding from deciding for
/// triangles that lie along the direction.
constexpr float least_facing_cosine = 1e-3f;

constexpr std::size_t stream_rays = 256;

/// Finds where in the segment from a to b, 0 to 1, the point closest to p lies.
double closest_in_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d ab = b - a;
  const double squared_length = ab.squaredNorm();
  return squared_length > 0 ? std::clamp((p - a).dot(ab) / squared_length, 0.0, 1.0) : 0;
}

/// Finds closest_weights of a triangle without area: the best of its sides.
Eigen::Vector2d closest_side_weights(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                     const Eigen::Vector3d& c) {
  const double on_ab = closest_in_segment(p, a, b), on_ac = closest_in_segment(p, a, c),
               on_bc = closest_in_segment(p, b, c);
  Eigen::Vector2d best(on_ab, 0);
  double least = (a + on_ab * (b - a) - p).squaredNorm();
  for (const Eigen::Vector2d& other : {Eigen::Vector2d(0, on_ac), Eigen::Vector2d(1 - on_bc, on_bc)}) {
    const double squared_distance = (a + other.x() * (b - a) + other.y() * (c - a) - p).squaredNorm();
    if (squared_distance < least) {
      least = squared_distance;
      best = other;
    }
  }
  return best;
}

/// Finds the point of a triangle closest to p, as weights of its second and third corner ([Ericson 2005], section
/// 5.1.5). In double, because float32 has no digits left for slivers.
Eigen::Vector2d closest_weights(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double squared_area = ab.cross(ac).squaredNorm();
  if (!(squared_area > 1e-24 * ab.squaredNorm() * ac.squaredNorm())) return closest_side_weights(p, a, b, c);
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {0, 0};
  const Eigen::Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {d1 / (d1 - d3), 0};
  const Eigen::Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {1 - w, w};
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return closest_side_weights(p, a, b, c);
  return {vb / sum, vc / sum};
}

}  // namespace

struct RayScene::Implementation {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Triangle> triangles;
  EmbreeScene embree;
  RTCScene scene = embree.scene();

  Implementation(std::span<const Eigen::Vector3f> own_positions, std::span<const Triangle> own_triangles)
      : positions(own_positions.begin(), own_positions.end()),
        triangles(own_triangles.begin(), own_triangles.end()),
        embree(positions, triangles) {}

  bool shows_front(std::uint32_t triangle, const Eigen::Vector3f& direction) const {
    const Triangle& t = triangles[triangle];
    return (positions[t[1]] - positions[t[0]]).cross(positions[t[2]] - positions[t[0]]).dot(direction) < 0;
  }

  /// Finds the closest point, only on triangles that face `facing` if that is not null.
  SurfacePoint closest(const Eigen::Vector3f& point, const Eigen::Vector3f* facing, float farthest) const;
};

SurfacePoint RayScene::Implementation::closest(const Eigen::Vector3f& point, const Eigen::Vector3f* facing,
                                               float farthest) const {
  struct Search {
    const Implementation* scene;
    Eigen::Vector3f point;
    const Eigen::Vector3f* facing;
    SurfacePoint best;
  } search = {this, point, facing, {}};
  RTCPointQuery query = {point.x(), point.y(), point.z(), 0, farthest};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(
      scene, &query, &context,
      [](RTCPointQueryFunctionArguments* arguments) {
        Search& own = *static_cast<Search*>(arguments->userPtr);
        const Triangle& t = own.scene->triangles[arguments->primID];
        const Eigen::Vector3f &a = own.scene->positions[t[0]], &b = own.scene->positions[t[1]],
                              &c = own.scene->positions[t[2]];
        if (own.facing != nullptr) {
          const Eigen::Vector3f normal = (b - a).cross(c - a);
          if (!(normal.dot(*own.facing) > least_facing_cosine * normal.norm() * own.facing->norm())) return false;
        }
        const Eigen::Vector3d p = own.point.cast<double>(), first = a.cast<double>();
        const Eigen::Vector2d weights = closest_weights(p, first, b.cast<double>(), c.cast<double>());
        const Eigen::Vector3d at =
            first + weights.x() * (b.cast<double>() - first) + weights.y() * (c.cast<double>() - first);
        const auto distance = static_cast<float>((at - p).norm());
        if (distance > arguments->query->radius || (own.best.found() && distance >= own.best.distance)) return false;
        own.best = {arguments->primID, static_cast<float>(weights.x()), static_cast<float>(weights.y()), distance};
        arguments->query->radius = distance;
        return true;
      },
      &search);
  return search.best;
}

RayScene::RayScene(const TriangleMesh& mesh) : RayScene(mesh.positions, mesh.triangles) {}

RayScene::RayScene(std::span<const Eigen::Vector3f> positions, std::span<const Triangle> triangles)
    : implementation_(std::make_unique<Implementation>(positions, triangles)) {}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

SurfacePoint RayScene::first_hit(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float nearest,
                                 float farthest) const {
  RTCRayHit query = {};
  query.ray = make_ray(origin, direction, nearest, farthest);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(implementation_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return {query.hit.primID, query.hit.u, query.hit.v, query.ray.tfar};
}

namespace {

/// Sixteen parallel rays for rtcIntersect16.
struct RayPacket {
  alignas(64) int valid[RayScene::PacketHits::lanes];
  RTCRayHit16 query;

  RayPacket(const float (&origin)[3][RayScene::PacketHits::lanes], const Eigen::Vector3f& direction, std::uint32_t rays,
            float nearest) {
    for (std::size_t k = 0; k < RayScene::PacketHits::lanes; ++k) {
      valid[k] = (rays >> k & 1) != 0 ? -1 : 0;
      query.ray.org_x[k] = origin[0][k];
      query.ray.org_y[k] = origin[1][k];
      query.ray.org_z[k] = origin[2][k];
      query.ray.tnear[k] = nearest;
      query.ray.dir_x[k] = direction.x();
      query.ray.dir_y[k] = direction.y();
      query.ray.dir_z[k] = direction.z();
      query.ray.time[k] = 0;
      query.ray.tfar[k] = std::numeric_limits<float>::infinity();
      query.ray.mask[k] = ~0u;
      query.ray.id[k] = 0;
      query.ray.flags[k] = 0;
      query.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
    }
  }

  void intersect(RTCScene scene) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(valid, scene, &context, &query);
  }
};

}  // namespace

void RayScene::first_distances(const float (&origin)[3][PacketHits::lanes], const Eigen::Vector3f& direction,
                               std::uint32_t rays, float nearest, float (&distances)[PacketHits::lanes]) const {
  RayPacket packet(origin, direction, rays, nearest);
  packet.intersect(implementation_->scene);
  for (std::size_t k = 0; k < PacketHits::lanes; ++k)
    distances[k] = packet.query.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID ? packet.query.ray.tfar[k]
                                                                         : std::numeric_limits<float>::infinity();
}

std::uint32_t RayScene::first_front_hits(const float (&origin)[3][PacketHits::lanes], const Eigen::Vector3f& direction,
                                         std::uint32_t rays, PacketHits& hits) const {
  RayPacket packet(origin, direction, rays, 0);
  packet.intersect(implementation_->scene);
  const RTCRayHit16& query = packet.query;
  std::uint32_t found = 0;
  for (; rays != 0; rays &= rays - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(rays));
    const Eigen::Vector3f from(origin[0][k], origin[1][k], origin[2][k]);
    SurfacePoint hit;
    if (query.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID)
      hit = {query.hit.primID[k], query.hit.u[k], query.hit.v[k], query.ray.tfar[k]};
    while (hit.found() && implementation_->embree.is_behind(from, direction, hit.triangle, hit.distance))
      hit = first_hit(from, direction, std::nextafter(hit.distance, std::numeric_limits<float>::infinity()),
                      std::numeric_limits<float>::infinity());
    if (!hit.found() || !implementation_->shows_front(hit.triangle, direction)) continue;
    hits.triangle[k] = hit.triangle;
    hits.u[k] = hit.u;
    hits.v[k] = hit.v;
    found |= 1u << k;
  }
  return found;
}

SurfacePoint RayScene::closest_point(const Eigen::Vector3f& point, float farthest) const {
  return implementation_->closest(point, nullptr, farthest);
}

SurfacePoint RayScene::closest_facing_point(const Eigen::Vector3f& point, const Eigen::Vector3f& facing,
                                            float farthest) const {
  return implementation_->closest(point, &facing, farthest);
}

void RayScene::occluded(std::span<const Eigen::Vector3f> origins, const Eigen::Vector3f& direction, float nearest,
                        std::span<std::uint8_t> occluded) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  std::array<RTCRay, stream_rays> rays;
  for (std::size_t begin = 0; begin < origins.size(); begin += stream_rays) {
    const std::size_t count = std::min(stream_rays, origins.size() - begin);
    for (std::size_t k = 0; k < count; ++k) rays[k] = make_ray(origins[begin + k], direction, nearest);
    rtcOccluded1M(implementation_->scene, &context, rays.data(), static_cast<unsigned>(count), sizeof(RTCRay));
    // Embree marks an occluded ray by setting its far end to minus infinity.
    for (std::size_t k = 0; k < count; ++k) occluded[begin + k] = rays[k].tfar < 0 ? 1 : 0;
  }
}

std::string ray_library_name() { return "Embree " RTC_VERSION_STRING; }

}  // namespace kiln
