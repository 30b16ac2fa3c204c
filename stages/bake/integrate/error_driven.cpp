// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/integrate/error_driven.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "bake/planes/quantisation_floor.h"
#include "base/progress.h"
#include "sh/directions.h"

namespace kiln {

namespace {

constexpr int fewest_directions = 64;
constexpr int steps_per_doubling = 4;
constexpr double half_difference_over_error = 1.15;

/// Returns the numbers of directions to try, whole blocks: the one steps_per_doubling before each is about half of it.
std::vector<int> direction_counts(int most) {
  std::vector<int> counts;
  for (int step = 0;; ++step) {
    const double count = fewest_directions / 2 * std::exp2(static_cast<double>(step) / steps_per_doubling);
    const int whole = static_cast<int>(std::lround(count / block_directions)) * block_directions;
    if (whole >= most) break;
    if (counts.empty() || whole > counts.back()) counts.push_back(whole);
  }
  counts.push_back(most);
  return counts;
}

/// Returns half the distance between the means over the first directions and over the others, relative to the whole
/// mean.
double half_difference(const TransferSums& first, const TransferSums& all) {
  const double first_weight = 1.0 / static_cast<double>(first.directions),
               other_weight = 1.0 / static_cast<double>(all.directions - first.directions),
               weight = 1.0 / static_cast<double>(all.directions);
  double difference = 0, reference = 0;
  for (std::size_t k = 0; k < all.values.size(); ++k) {
    const auto part = static_cast<double>(first.values[k]), whole = static_cast<double>(all.values[k]);
    const double d = 0.5 * (part * first_weight - (whole - part) * other_weight), t = whole * weight;
    difference += d * d;
    reference += t * t;
  }
  return difference == 0 ? 0 : std::sqrt(difference / reference);
}

}  // namespace

DirectionChoice choose_directions(TransferEngine& engine, const Receivers& sample, const BakeJob& job) {
  const BakeSettings& settings = job.settings;
  const ErrorTarget& target = settings.max_error;
  engine.set_receivers(sample, settings.bands);
  DirectionChoice choice;
  std::vector<TransferSums> history;
  const std::vector<int> counts = direction_counts(settings.max_directions);
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const int before = k == 0 ? 0 : counts[k - 1];
    engine.add(progressive_directions(before, counts[k] - before, static_cast<std::uint64_t>(job.seed)), no_progress);
    history.push_back(engine.sums());
    job.progress(static_cast<double>(k + 1) / static_cast<double>(counts.size()));
    if (counts[k] < fewest_directions) continue;
    // Find the earlier prefix nearest to half of this one.
    const auto half = std::min_element(history.begin(), history.end() - 1, [&](const auto& a, const auto& b) {
      return std::abs(2 * a.directions - counts[k]) < std::abs(2 * b.directions - counts[k]);
    });
    choice.directions = counts[k];
    choice.estimated_error = half_difference(*half, history.back()) / half_difference_over_error;
    choice.target_error = target.floor ? quantisation_floor(history.back().transfer(), settings.bits) : target.error;
    if (choice.estimated_error <= choice.target_error) break;
  }
  return choice;
}

}  // namespace kiln
