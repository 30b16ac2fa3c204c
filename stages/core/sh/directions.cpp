// SPDX-License-Identifier: MIT
#include "sh/directions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace kiln {

namespace {

/// Returns the upper 53 bits of a fraction in units of 2^-64.
double as_fraction(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

/// Draws a number from [0, 1) uniformly. std::uniform_real_distribution may differ between libraries; this does not.
double uniform(std::mt19937_64& random) { return as_fraction(random()); }

/// Draws a uniformly distributed rotation [Shoemake 1992].
Eigen::Quaterniond random_rotation(std::mt19937_64& random) {
  const double u = uniform(random), v = 2 * std::numbers::pi * uniform(random),
               w = 2 * std::numbers::pi * uniform(random);
  return {std::sqrt(u) * std::cos(w), std::sqrt(1 - u) * std::sin(v), std::sqrt(1 - u) * std::cos(v),
          std::sqrt(u) * std::sin(w)};
}

/// Maps a height z in [-1, 1] and an azimuth in turns to the sphere, with equal areas.
Eigen::Vector3d on_sphere(double z, double turns) {
  const double radius = std::sqrt(std::max(0.0, 1 - z * z));
  const double phi = 2 * std::numbers::pi * turns;
  return {radius * std::cos(phi), radius * std::sin(phi), z};
}

/// Returns the radical inverse of `index` in base 2, in units of 2^-64: its bits in reverse order.
std::uint64_t radical_inverse(std::uint64_t index) {
  std::uint64_t inverse = 0;
  for (std::uint64_t bit = 1ull << 63; index != 0; index >>= 1, bit >>= 1)
    if (index & 1) inverse |= bit;
  return inverse;
}

/// Ranks azimuths: grows from 0 to 4 over a turn; unlike atan2 the same on any machine.
float azimuth_rank(const Eigen::Vector3f& direction) {
  const float sum = std::abs(direction.x()) + std::abs(direction.y());
  if (sum == 0) return 0;
  const float across = direction.x() / sum;
  return direction.y() >= 0 ? 1 - across : 3 + across;
}

}  // namespace

std::vector<Eigen::Vector3f> sample_directions(Sampling sampling, int count, std::uint64_t seed) {
  if (sampling == Sampling::progressive) return progressive_directions(0, count, seed);

  std::mt19937_64 random(seed);
  std::vector<Eigen::Vector3f> directions;
  directions.reserve(count);
  const auto keep = [&](const Eigen::Vector3d& direction) {
    directions.emplace_back(direction.normalized().cast<float>());
  };

  if (sampling == Sampling::fibonacci) {
    const Eigen::Matrix3d rotation = random_rotation(random).toRotationMatrix();
    for (int i = 0; i < count; ++i) {
      const double turns = i * (std::numbers::phi - 1);
      keep(rotation * on_sphere(1 - (2.0 * i + 1) / count, turns - std::floor(turns)));
    }
    return directions;
  }

  // Rows of about as many cells as there are rows; a row with more cells is taller, so that all cells have the same
  // area.
  const int rows = std::max(1, static_cast<int>(std::lround(std::sqrt(static_cast<double>(count)))));
  for (int row = 0; row < rows; ++row) {
    const auto cells_below = [&](int r) { return static_cast<long long>(r) * count / rows; };
    const int cells = static_cast<int>(cells_below(row + 1) - cells_below(row));
    for (int cell = 0; cell < cells; ++cell) {
      const double t = (static_cast<double>(cells_below(row)) + cells * uniform(random)) / count;
      keep(on_sphere(1 - 2 * t, (cell + uniform(random)) / cells));
    }
  }
  return directions;
}

std::int64_t directions_for_bands(Sampling sampling, int bands) {
  const std::int64_t per_coefficient = sampling == Sampling::fibonacci     ? 4
                                       : sampling == Sampling::progressive ? 16
                                                                           : 32;
  return per_coefficient * bands * bands;
}

std::vector<Eigen::Vector3f> progressive_directions(std::int64_t first, int count, std::uint64_t seed) {
  // The multiplier comes from a search, digit by digit, for lattices whose dual lattice has the least sum of |k|^-3
  // (the spectrum of caps) at all heights of the sphere and all sizes 2^5 to 2^30. Of the best two hundred, it is the
  // one whose prefixes up to 8,192 have the least spherical cap discrepancy (by Stolarsky's invariance principle, from
  // distances between pairs).
  constexpr std::uint64_t multiplier = 124'176'601;
  // An offset of a third centres the heights: 2^m lattice heights k / 2^m are then a sixth of a step off centre at any
  // m; without an offset, half a step.
  constexpr std::uint64_t third = 0x5555'5555'5555'5555;

  std::mt19937_64 random(seed);
  const Eigen::Matrix3d rotation = random_rotation(random).toRotationMatrix();
  std::vector<Eigen::Vector3f> directions;
  directions.reserve(count);
  for (int i = 0; i < count; ++i) {
    const std::uint64_t inverse = radical_inverse(static_cast<std::uint64_t>(first + i));  // products wrap: fractions
    const Eigen::Vector3d point = on_sphere(1 - 2 * as_fraction(inverse + third), as_fraction(inverse * multiplier));
    directions.emplace_back((rotation * point).normalized().cast<float>());
  }
  return directions;
}

void order_coherently(std::vector<Eigen::Vector3f>& directions, int block) {
  const auto begin = directions.begin();
  std::stable_sort(begin, directions.end(), [](const auto& a, const auto& b) { return a.z() > b.z(); });

  // The sphere is cut into two caps of one patch each and collars between them, about as high as a patch is wide. Each
  // collar takes the whole number of patches that keeps the sum of all above it nearest to their area.
  const auto count = static_cast<std::int64_t>(directions.size());
  const std::int64_t patches = (count + block - 1) / block;
  if (patches <= 2) return;
  const double cap_angle = std::acos(1 - 2.0 / static_cast<double>(patches));
  const double patch_side = std::sqrt(4 * std::numbers::pi / static_cast<double>(patches));
  const auto collars = std::max<std::int64_t>(1, std::llround((std::numbers::pi - 2 * cap_angle) / patch_side));
  std::int64_t first_patch = 1;
  for (std::int64_t collar = 1; collar <= collars; ++collar) {
    const double bottom =
        cap_angle + (std::numbers::pi - 2 * cap_angle) * static_cast<double>(collar) / static_cast<double>(collars);
    const std::int64_t end_patch = std::llround(static_cast<double>(patches) * (1 - std::cos(bottom)) / 2);
    std::stable_sort(begin + first_patch * block, begin + std::min(count, end_patch * block),
                     [](const auto& a, const auto& b) { return azimuth_rank(a) < azimuth_rank(b); });
    first_patch = end_patch;
  }
}

Eigen::Vector3f direction_from_angles(double azimuth_degrees, double elevation_degrees) {
  const double azimuth = azimuth_degrees * std::numbers::pi / 180,
               elevation = elevation_degrees * std::numbers::pi / 180;
  return Eigen::Vector3d(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                         std::cos(elevation) * std::cos(azimuth))
      .cast<float>();
}

}  // namespace kiln
