// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/bounce_paths.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <stdexcept>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "mesh/surface_point.h"
#include "sh/basis.h"

namespace kiln {

namespace {

using Random = std::minstd_rand;

/// Returns a number of 0 to 1 from the upper bits.
float uniform(Random& random) {
  return static_cast<float>(random() - Random::min()) / static_cast<float>(Random::max() - Random::min());
}

/// Spreads a number over all bits, so that neighbours get unlike sequences ([Steele 2014], its finaliser).
std::uint64_t mixed(std::uint64_t number) {
  number += 0x9e3779b97f4a7c15u;
  number = (number ^ (number >> 30)) * 0xbf58476d1ce4e5b9u;
  number = (number ^ (number >> 27)) * 0x94d049bb133111ebu;
  return number ^ (number >> 31);
}

/// End of a path: the direction in which it leaves the scene, and the share of each colour that it carries.
struct Escape {
  Eigen::Vector3f direction;
  Eigen::Vector3f throughput;
};

/// Follows paths of one scene.
class Walker {
 public:
  Walker(const RayScene& scene, const SceneMesh& surface, int bounces, float ray_offset)
      : scene_(scene), surface_(surface), bounces_(bounces), ray_offset_(ray_offset) {}

  /// Follows a path that leaves `origin` along `direction`. Nothing where it meets the sky at once, a back face, or the
  /// surface more often than light bounces.
  std::optional<Escape> walk(Eigen::Vector3f origin, Eigen::Vector3f direction, Random& random) const {
    Eigen::Vector3f throughput = Eigen::Vector3f::Ones();
    for (int hits = 0;; ++hits) {
      const SurfacePoint hit = scene_.first_hit(origin, direction, 0, std::numeric_limits<float>::infinity());
      if (!hit.found()) return hits > 0 ? std::optional(Escape{direction, throughput}) : std::nullopt;
      const Eigen::Vector3f normal = face_normal(surface_.mesh, hit.triangle);
      if (hits == bounces_ || normal.dot(direction) >= 0) return std::nullopt;
      throughput = throughput.cwiseProduct(surface_.albedo_at(hit.triangle, hit.u, hit.v));
      if (throughput.maxCoeff() <= 0) return std::nullopt;
      origin = position_at(surface_.mesh, hit) + ray_offset_ * normal;
      const float squared_sine = uniform(random), turn = uniform(random);
      direction = cosine_direction(normal, squared_sine, turn);
    }
  }

 private:
  const RayScene& scene_;
  const SceneMesh& surface_;
  int bounces_;
  float ray_offset_;
};

}  // namespace

Eigen::Vector3f cosine_direction(const Eigen::Vector3f& normal, float squared_sine, float turn) {
  const float azimuth = 2 * std::numbers::pi_v<float> * turn, sine = std::sqrt(squared_sine);
  const Eigen::Vector3f across = normal.unitOrthogonal(), along = normal.cross(across);
  return (sine * std::cos(azimuth) * across + sine * std::sin(azimuth) * along +
          std::sqrt(std::max(0.f, 1 - squared_sine)) * normal)
      .normalized();
}

BouncePaths::BouncePaths(const RayScene& scene, const SceneMesh& surface, int bounces, float ray_offset)
    : scene_(scene), surface_(surface), bounces_(bounces), ray_offset_(ray_offset) {
  if (surface.albedos.empty()) throw std::invalid_argument("BouncePaths: a surface without albedo");
}

void BouncePaths::add(const Receivers& receivers, std::span<const Eigen::Vector3f> directions, std::uint64_t first,
                      std::vector<TransferVectors>& channels) const {
  const int coefficients = channels.front().coefficients;
  const ShBasis basis(band_of(coefficients - 1) + 1);
  const Walker walker(scene_, surface_, bounces_, ray_offset_);
  // Each direction stands for 4 pi / n of the sphere, and transfer has 1 / pi of the integral.
  const float weight = 4.f / static_cast<float>(directions.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, receivers.size(), 64), [&](const auto& range) {
    std::vector<float> row(static_cast<std::size_t>(coefficients));
    Eigen::ArrayXXd sums(coefficients, 3);
    for (std::size_t r = range.begin(); r != range.end(); ++r) {
      Random random(static_cast<Random::result_type>(mixed(first + r)));
      sums.setZero();
      const Eigen::Vector3f& normal = receivers.normals[r];
      const Eigen::Vector3f origin = receivers.positions[r] + ray_offset_ * normal;
      for (const Eigen::Vector3f& direction : directions) {
        const float cosine = normal.dot(direction);
        if (cosine <= 0) continue;
        const std::optional<Escape> escape = walker.walk(origin, direction, random);
        if (!escape) continue;
        basis.evaluate<float>(escape->direction, row);
        for (int c = 0; c < 3; ++c)
          sums.col(c) += Eigen::Map<const Eigen::ArrayXf>(row.data(), coefficients).cast<double>() *
                         double{weight * cosine * escape->throughput[c]};
      }
      for (int c = 0; c < 3; ++c)
        for (int i = 0; i < coefficients; ++i) channels[c].plane(i)[r] += static_cast<float>(sums(i, c));
    }
  });
}

}  // namespace kiln
