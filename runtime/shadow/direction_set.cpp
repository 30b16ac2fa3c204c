// SPDX-License-Identifier: MIT
#include "runtime/shadow/direction_set.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sh/basis.h"
#include "sh/directions.h"

namespace kiln {

namespace {

constexpr std::uint32_t block_directions = DirectionSet::block_directions;

DirectionSet make_set(const std::vector<Eigen::Vector3f>& directions, int bands) {
  DirectionSet set;
  for (const Eigen::Vector3f& direction : directions) {
    set.x.push_back(direction.x());
    set.y.push_back(direction.y());
    set.z.push_back(direction.z());
  }
  for (std::size_t first = 0; first < directions.size(); first += block_directions) {
    const std::size_t last = std::min(first + block_directions, directions.size());
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (std::size_t d = first; d < last; ++d) sum += directions[d];
    DirectionSet::Block block{sum.norm() > 1e-6f ? sum.normalized().eval() : Eigen::Vector3f::UnitZ(), 0, 1, 0};
    float cosine = 1;
    for (std::size_t d = first; d < last; ++d) cosine = std::min(cosine, block.axis.dot(directions[d]));
    block.half_angle = std::acos(std::clamp(cosine, -1.f, 1.f)) + 1e-3f;  // and some for rounding
    block.cosine = std::cos(block.half_angle);
    block.sine = std::sin(block.half_angle);
    set.blocks.push_back(block);
  }
  if (bands == 0) return set;
  const ShBasis basis(bands);
  set.coefficients = basis.size();
  set.basis.resize(directions.size() * static_cast<std::size_t>(basis.size()));
  for (std::uint32_t d = 0; d < set.count(); ++d)
    basis.evaluate<float>(directions[d], std::span(set.basis).subspan(static_cast<std::size_t>(d) * basis.size(),
                                                                      static_cast<std::size_t>(basis.size())));
  return set;
}

}  // namespace

DirectionSet sphere_directions(int count, int bands) {
  std::vector<Eigen::Vector3f> directions = sample_directions(Sampling::fibonacci, count, 1);
  order_coherently(directions, static_cast<int>(block_directions));
  return make_set(directions, bands);
}

DiscPattern disc_pattern(int count) {
  struct Point {
    int ring, sector;
    double share, azimuth;
  };
  // Cuts the disc into rings and these into sectors of equal shares, so that blocks are compact.
  std::vector<Point> points;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  const int rings = std::max(1, static_cast<int>(std::lround(std::sqrt(count / 32.0))));
  for (int k = 0; k < count; ++k) {
    const double share = (k + 0.5) / count, azimuth = std::fmod(golden * k, 2 * std::numbers::pi);
    const int ring = static_cast<int>(std::sqrt(share) * rings), sectors = 2 * ring + 1;
    points.push_back({ring, static_cast<int>(azimuth / (2 * std::numbers::pi) * sectors), share, azimuth});
  }
  std::stable_sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
    return a.ring != b.ring ? a.ring < b.ring : a.sector < b.sector;
  });
  DiscPattern pattern;
  for (const Point& point : points) {
    pattern.share.push_back(static_cast<float>(point.share));
    pattern.cosine.push_back(static_cast<float>(std::cos(point.azimuth)));
    pattern.sine.push_back(static_cast<float>(std::sin(point.azimuth)));
  }
  return pattern;
}

DirectionSet cone_directions(const DiscPattern& pattern, const Eigen::Vector3d& axis, double half_angle, int bands) {
  const Eigen::Matrix3f turn =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).toRotationMatrix().cast<float>();
  // 1 - cos, without its cancellation for thin cones; 1 - z^2 is (1 - z) (1 + z).
  const auto depth = static_cast<float>(2 * std::pow(std::sin(0.5 * half_angle), 2));
  std::vector<Eigen::Vector3f> directions;
  directions.reserve(pattern.share.size());
  for (std::size_t k = 0; k < pattern.share.size(); ++k) {
    const float below = pattern.share[k] * depth, radius = std::sqrt(std::max(0.f, below * (2 - below)));
    directions.push_back(turn * Eigen::Vector3f(radius * pattern.cosine[k], radius * pattern.sine[k], 1 - below));
  }
  return make_set(directions, bands);
}

void find_in_cone(const DirectionSet& set, const Eigen::Vector3f& axis, float half_angle,
                  std::span<const std::uint8_t> blocked, std::vector<std::uint32_t>& found) {
  constexpr auto straight = std::numbers::pi_v<float>;
  const float cosine = half_angle >= straight ? -2.f : std::cos(half_angle);
  for (std::size_t b = 0; b < set.blocks.size(); ++b) {
    const DirectionSet::Block& block = set.blocks[b];
    const float reach = half_angle + block.half_angle;
    if (reach < straight && axis.dot(block.axis) < std::cos(reach)) continue;
    const auto first = static_cast<std::uint32_t>(b) * block_directions,
               last = std::min(first + block_directions, set.count());
    for (std::uint32_t d = first; d < last; ++d)
      if (blocked[d] == 0 && axis.x() * set.x[d] + axis.y() * set.y[d] + axis.z() * set.z[d] >= cosine)
        found.push_back(d);
  }
}

}  // namespace kiln
