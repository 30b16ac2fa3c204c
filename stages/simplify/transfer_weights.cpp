// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/transfer_weights.h"

#include <algorithm>

#include "raycast/surface_transfer.h"
#include "sh/basis.h"
#include "sh/light_prior.h"

namespace kiln {

namespace {

constexpr int bands = 4;
constexpr double gain = 4, largest_weight = 100;

/// Distance of two points' transfer vectors, as the lighting prior weighs it.
class TransferDistance {
 public:
  explicit TransferDistance(const TransferVectors& transfer) : transfer_(transfer), prior_(lighting_prior(bands)) {}

  double squared(std::uint32_t a, std::uint32_t b) const {
    double sum = 0;
    for (int i = 0; i < transfer_.coefficients; ++i) {
      const double difference = static_cast<double>(transfer_.plane(i)[a]) - transfer_.plane(i)[b];
      sum += prior_[static_cast<std::size_t>(band_of(i))] * difference * difference;
    }
    return sum;
  }

 private:
  const TransferVectors& transfer_;
  std::vector<double> prior_;
};

}  // namespace

std::vector<double> transfer_weights(const TriangleMesh& mesh) {
  TriangleMesh smooth = mesh;
  compute_vertex_normals(smooth);
  const TransferVectors transfer =
      surface_transfer(smooth, {smooth.positions, smooth.normals}, {.bands = bands, .directions = 256});
  const TransferDistance distance(transfer);

  // Average the squared slopes of the edges at each vertex, long ones counting more; inner edges count twice, from both
  // sides.
  std::vector<double> slopes(mesh.positions.size(), 0), lengths(mesh.positions.size(), 0);
  for (const Triangle& triangle : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangle[k], b = triangle[(k + 1) % 3];
      const double apart = distance.squared(a, b);
      const double length = (mesh.positions[a] - mesh.positions[b]).cast<double>().squaredNorm();
      for (const std::uint32_t vertex : {a, b}) {
        slopes[vertex] += apart;
        lengths[vertex] += length;
      }
    }
  double sum = 0, used = 0;
  for (std::size_t v = 0; v < slopes.size(); ++v) {
    if (!(lengths[v] > 0)) continue;
    slopes[v] /= lengths[v];
    sum += slopes[v];
    used += 1;
  }
  std::vector<double> weights(slopes.size(), 1.0);
  if (!(sum > 0)) return weights;
  for (std::size_t v = 0; v < weights.size(); ++v)
    weights[v] = std::min(largest_weight, 1 + gain * slopes[v] * used / sum);
  return weights;
}

}  // namespace kiln
