// SPDX-License-Identifier: MIT
#include "asset/probe_set.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace kiln {

namespace {

constexpr std::size_t nearest_probes = 8;

using Weights = std::vector<std::pair<std::size_t, float>>;

void normalise(Weights& weights) {
  float sum = 0;
  for (const auto& [probe, weight] : weights) sum += weight;
  for (auto& [probe, weight] : weights) weight /= sum;
}

Weights grid_weights(const ProbeSet& probes, const Eigen::Vector3f& position) {
  const ProbeGrid& grid = *probes.grid;
  std::array<int, 3> cell{};
  Eigen::Vector3f within = Eigen::Vector3f::Zero();  // position in the cell: 0 at its lower corner, 1 at its upper one
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const float length = grid.upper[axis] - grid.lower[axis];
    if (grid.size[a] == 1 || !(length > 0)) continue;
    const float place =
        std::clamp((position[axis] - grid.lower[axis]) / length, 0.f, 1.f) * static_cast<float>(grid.size[a] - 1);
    cell[a] = std::min(static_cast<int>(place), grid.size[a] - 2);
    within[axis] = place - static_cast<float>(cell[a]);
  }
  Weights weights;
  for (int corner = 0; corner < 8; ++corner) {
    float weight = 1;
    std::size_t index = 0, stride = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const int up = corner >> axis & 1;
      weight *= up == 1 ? within[axis] : 1 - within[axis];
      index += stride * static_cast<std::size_t>(cell[a] + up);
      stride *= static_cast<std::size_t>(grid.size[a]);
    }
    // Skips corners of weight 0: an axis of one point has no upper corner.
    if (weight > 0 && probes.valid[index] != 0) weights.emplace_back(index, weight);
  }
  return weights;
}

Weights nearest_weights(const ProbeSet& probes, const Eigen::Vector3f& position, std::size_t most) {
  Weights nearest;  // with squared distances, nearest first
  for (std::size_t k = 0; k < probes.positions.size(); ++k) {
    if (probes.valid[k] == 0) continue;
    const float distance = (probes.positions[k] - position).squaredNorm();
    if (nearest.size() == most && distance >= nearest.back().second) continue;
    if (nearest.size() == most) nearest.pop_back();
    const auto farther =
        std::find_if(nearest.begin(), nearest.end(), [&](const auto& other) { return distance < other.second; });
    nearest.insert(farther, {k, distance});
  }
  if (nearest.empty()) return nearest;
  if (nearest.front().second == 0) return {{nearest.front().first, 1.f}};
  const float least = nearest.front().second;  // dividing by the smallest keeps every weight from overflowing
  for (auto& [probe, weight] : nearest) weight = least / weight;
  return nearest;
}

}  // namespace

Eigen::Vector3f ProbeGrid::position(std::size_t index) const {
  Eigen::Vector3f result;
  for (int axis = 0; axis < 3; ++axis) {
    const auto points = static_cast<std::size_t>(size[static_cast<std::size_t>(axis)]);
    const auto place = static_cast<float>(index % points);
    const float share = points == 1 ? 0.5f : place / static_cast<float>(points - 1);
    result[axis] = lower[axis] + share * (upper[axis] - lower[axis]);
    index /= points;
  }
  return result;
}

Weights probe_weights(const ProbeSet& probes, const Eigen::Vector3f& position) {
  Weights weights = probes.grid ? grid_weights(probes, position) : nearest_weights(probes, position, nearest_probes);
  if (weights.empty()) weights = nearest_weights(probes, position, 1);
  if (!weights.empty()) normalise(weights);
  return weights;
}

LightCoefficients light_at(const ProbeSet& probes, const Eigen::Vector3f& position, const LightCoefficients& source) {
  const std::size_t sources = source.channels.size(), matrices = static_cast<std::size_t>(probes.channels);
  if (sources != matrices && sources != 1 && matrices != 1)
    throw std::invalid_argument("a light of other channels than the probes");
  const Weights weights = probe_weights(probes, position);
  const auto size = static_cast<std::size_t>(probes.coefficients());
  LightCoefficients light{probes.bands, {}};
  for (std::size_t c = 0; c < std::max(sources, matrices); ++c) {
    std::vector<float> from = source.channels[std::min(c, sources - 1)];
    from.resize(size, 0.f);
    std::vector<float>& to = light.channels.emplace_back(size, 0.f);
    for (const auto& [probe, weight] : weights) {
      const std::span<const float> matrix = probes.matrix(probe, static_cast<int>(std::min(c, matrices - 1)));
      for (std::size_t i = 0; i < size; ++i) {
        float sum = 0;
        for (std::size_t j = 0; j < size; ++j) sum += matrix[i * size + j] * from[j];
        to[i] += weight * sum;
      }
    }
    if (weights.empty()) to = from;
  }
  return light;
}

}  // namespace kiln
