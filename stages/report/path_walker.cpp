// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/path_walker.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mesh/surface_point.h"

namespace kiln {

namespace {

std::uint64_t mixed(std::uint64_t number) {
  number = (number ^ (number >> 30)) * 0xbf58476d1ce4e5b9u;
  number = (number ^ (number >> 27)) * 0x94d049bb133111ebu;
  return number ^ (number >> 31);
}

constexpr std::uint64_t golden_step = 0x9e3779b97f4a7c15u;

}  // namespace

PathRandom::PathRandom(std::uint64_t receiver) : state_(mixed(receiver + golden_step)) {}

float PathRandom::uniform() {
  state_ += golden_step;
  constexpr int mantissa_bits = 24;
  return static_cast<float>(mixed(state_) >> (64 - mantissa_bits)) * std::ldexp(1.f, -mantissa_bits);
}

Eigen::Vector3f cosine_direction(const Eigen::Vector3f& normal, float squared_sine, float turn) {
  const float azimuth = 2 * std::numbers::pi_v<float> * turn, sine = std::sqrt(squared_sine);
  const Eigen::Vector3f across = normal.unitOrthogonal(), along = normal.cross(across);
  return (sine * std::cos(azimuth) * across + sine * std::sin(azimuth) * along +
          std::sqrt(std::max(0.f, 1 - squared_sine)) * normal)
      .normalized();
}

PathWalker::PathWalker(const RayScene& scene, const SceneMesh& surface, int bounces, float ray_offset,
                       const std::vector<int>& wavelengths_nm)
    : scene_(scene),
      surface_(surface),
      albedo_(surface.albedos, wavelengths_nm),
      bounces_(bounces),
      ray_offset_(ray_offset) {}

std::optional<Escape> PathWalker::walk(Eigen::Vector3f origin, Eigen::Vector3f direction, PathRandom& random) const {
  PathShares throughput = PathShares::Ones(channels());
  for (int hits = 0;; ++hits) {
    const SurfacePoint hit = scene_.first_hit(origin, direction, 0, std::numeric_limits<float>::infinity());
    if (!hit.found()) return Escape{direction, throughput, hits};
    const Eigen::Vector3f normal = face_normal(surface_.mesh, hit.triangle);
    if (hits == bounces_ || normal.dot(direction) >= 0) return std::nullopt;
    const std::size_t part = surface_.part_of(hit.triangle);
    throughput *= albedo_.at(part, hit.triangle - surface_.first_triangles[part], hit.u, hit.v);
    if (throughput.maxCoeff() <= 0) return std::nullopt;
    origin = position_at(surface_.mesh, hit) + ray_offset_ * normal;
    const float squared_sine = random.uniform(), turn = random.uniform();
    direction = cosine_direction(normal, squared_sine, turn);
  }
}

}  // namespace kiln
