// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/bounce_paths.h"

#include <optional>
#include <stdexcept>

#include "base/parallel.h"
#include "sh/basis.h"

namespace kiln {

BouncePaths::BouncePaths(const RayScene& scene, const SceneMesh& surface, int bounces, float ray_offset,
                         const std::vector<int>& wavelengths_nm)
    : walker_(scene, surface, bounces, ray_offset, wavelengths_nm) {
  if (surface.albedos.empty()) throw std::invalid_argument("BouncePaths: a surface without albedo");
}

void BouncePaths::add(const Receivers& receivers, std::span<const Eigen::Vector3f> directions, std::uint64_t first,
                      std::vector<TransferVectors>& channels) const {
  const int coefficients = channels.front().coefficients;
  const ShBasis basis(band_of(coefficients - 1) + 1);
  const int shares = walker_.channels();
  // Each direction stands for 4 pi / n of the sphere, and transfer has 1 / pi of the integral.
  const float weight = 4.f / static_cast<float>(directions.size());
  parallel_ranges(0, receivers.size(), 64, [&](std::size_t begin, std::size_t end) {
    std::vector<float> row(static_cast<std::size_t>(coefficients));
    Eigen::ArrayXXd sums(coefficients, shares);
    for (std::size_t r = begin; r != end; ++r) {
      PathRandom random(first + r);
      sums.setZero();
      const Eigen::Vector3f& normal = receivers.normals[r];
      const Eigen::Vector3f origin = receivers.positions[r] + walker_.ray_offset() * normal;
      for (const Eigen::Vector3f& direction : directions) {
        const float cosine = normal.dot(direction);
        if (cosine <= 0) continue;
        const std::optional<Escape> escape = walker_.walk(origin, direction, random);
        if (!escape || escape->bounces == 0) continue;
        basis.evaluate<float>(escape->direction, row);
        for (int c = 0; c < shares; ++c)
          sums.col(c) += Eigen::Map<const Eigen::ArrayXf>(row.data(), coefficients).cast<double>() *
                         double{weight * cosine * escape->throughput[c]};
      }
      for (int c = 0; c < shares; ++c)
        for (int i = 0; i < coefficients; ++i) channels[c].plane(i)[r] += static_cast<float>(sums(i, c));
    }
  });
}

}  // namespace kiln
