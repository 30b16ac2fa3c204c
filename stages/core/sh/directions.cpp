#include "sh/directions.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

namespace kiln {

namespace {

/// Uniform in [0, 1). std::uniform_real_distribution may differ between libraries; this does not.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

/// A uniformly distributed rotation (Shoemake, "Uniform random rotations", Graphics Gems III, 1992).
Eigen::Quaterniond random_rotation(std::mt19937_64& random) {
  const double u = uniform(random), v = 2 * std::numbers::pi * uniform(random),
               w = 2 * std::numbers::pi * uniform(random);
  return {std::sqrt(u) * std::cos(w), std::sqrt(1 - u) * std::sin(v), std::sqrt(1 - u) * std::cos(v),
          std::sqrt(u) * std::sin(w)};
}

/// The equal-area map from height z in [-1, 1] and azimuth in turns.
Eigen::Vector3d on_sphere(double z, double turns) {
  const double radius = std::sqrt(std::max(0.0, 1 - z * z));
  const double phi = 2 * std::numbers::pi * turns;
  return {radius * std::cos(phi), radius * std::sin(phi), z};
}

}  // namespace

std::vector<Eigen::Vector3f> sample_directions(Sampling sampling, int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Eigen::Vector3f> directions;
  directions.reserve(count);
  const auto keep = [&](const Eigen::Vector3d& direction) {
    directions.push_back(direction.normalized().cast<float>());
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

Eigen::Vector3f direction_from_angles(double azimuth_degrees, double elevation_degrees) {
  const double azimuth = azimuth_degrees * std::numbers::pi / 180,
               elevation = elevation_degrees * std::numbers::pi / 180;
  return Eigen::Vector3d(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                         std::cos(elevation) * std::cos(azimuth))
      .cast<float>();
}

}  // namespace kiln
