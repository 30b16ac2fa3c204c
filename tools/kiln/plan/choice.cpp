// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/plan/choice.h"

#include <algorithm>
#include <cmath>

namespace kiln {

namespace {

constexpr double least_reserve = 0.1;  // of the error, for what a pilot cannot know
constexpr int most_triangles = 200000;

/// Returns counts that grow by the root of two, from those of the coarse pilot up to those of the high mesh.
std::vector<int> triangle_counts(const Pilot& pilot) {
  if (pilot.has_own_low) return {static_cast<int>(pilot.fine.triangles)};
  std::vector<int> counts;
  const int most = std::min(most_triangles, static_cast<int>(std::min(pilot.input_triangles, 1e9)));
  for (double count = pilot.coarse.triangles; count < most; count *= std::sqrt(2.0)) {
    // Two digits are enough for people.
    const double unit = std::pow(10, std::floor(std::log10(count)) - 1);
    counts.push_back(static_cast<int>(std::round(count / unit) * unit));
  }
  counts.push_back(std::max(most, 4));
  return counts;
}

/// Returns the choice that is least by `value` among those that keep the goal's bytes and seconds.
template <class Value>
std::optional<PlannedChoice> least_by(const AssetModel& model, const std::vector<Choice>& choices, const PlanGoal& goal,
                                      const Value& value) {
  std::optional<PlannedChoice> best;
  double least = std::numeric_limits<double>::infinity();
  for (const Choice& choice : choices) {
    const Prediction prediction = model.predict(choice);
    if (prediction.bytes > goal.bytes || prediction.cpu_seconds > goal.seconds) continue;
    if (const double here = value(prediction); here < least) {
      least = here;
      best = PlannedChoice{choice, prediction};
    }
  }
  return best;
}

}  // namespace

double cost_of(const Prediction& prediction, PlanCost cost) {
  if (cost == PlanCost::seconds) return prediction.cpu_seconds;
  return cost == PlanCost::bytes ? prediction.bytes : prediction.cpu_seconds * prediction.bytes;
}

ChoiceGrid full_grid(const AssetModel& model) {
  ChoiceGrid grid;
  grid.triangles = triangle_counts(model.pilot());
  for (const int size : {64, 96, 128, 192, 256, 384, 512, 768, 1024, 1536, 2048, 4096})
    if (size >= model.pilot().coarse.size) grid.sizes.push_back(size);
  for (int bands = 1; bands <= model.most_bands(); ++bands) grid.bands.push_back(bands);
  grid.directions = {64,   96,   128,  192,  256,  384,  512,   768,   1024,
                     1536, 2048, 3072, 4096, 6144, 8192, 12288, 16384, 32768};
  // The first of equally cheap choices is taken: the one without shadows, if it serves.
  if (model.pilot().may_be_unshadowed) grid.directions.insert(grid.directions.begin(), 0);
  grid.bits = {8, 16};
  grid.bounces = {model.pilot().must_bounce};
  if (model.pilot().has_bounces && !model.pilot().must_bounce) grid.bounces.push_back(true);
  if (model.pilot().must_be_vertices)
    grid.per_vertex = {true};
  else if (model.pilot().may_be_vertices)
    grid.per_vertex = {false, true};
  return grid;
}

std::vector<Choice> choices_of(const ChoiceGrid& grid, double compression) {
  std::vector<Choice> choices;
  const auto add = [&](int size, bool per_vertex) {
    for (const int triangles : grid.triangles)
      for (const int bands : grid.bands)
        for (const int directions : grid.directions)
          for (const int bits : grid.bits) {
            // Fewer do not keep the functions apart (kiln-bake warns of it).
            if (directions > 0 && directions < 4 * bands * bands) continue;
            for (const bool bounces : grid.bounces)
              choices.push_back({triangles, size, bands, directions, bits, bounces, compression, per_vertex});
          }
  };
  for (const bool per_vertex : grid.per_vertex) {
    if (per_vertex) add(0, true);
    for (const int size : grid.sizes)
      if (!per_vertex) add(size, false);
  }
  return choices;
}

std::optional<PlannedChoice> cheapest(const AssetModel& model, const std::vector<Choice>& choices,
                                      const PlanGoal& goal) {
  return least_by(model, choices, goal, [&](const Prediction& prediction) {
    const double reserve = std::max(least_reserve * prediction.error, prediction.uncertainty);
    return prediction.error + reserve <= goal.error ? cost_of(prediction, goal.cost)
                                                    : std::numeric_limits<double>::infinity();
  });
}

std::optional<PlannedChoice> most_accurate(const AssetModel& model, const std::vector<Choice>& choices,
                                           const PlanGoal& goal) {
  return least_by(model, choices, goal, [](const Prediction& prediction) { return prediction.error; });
}

}  // namespace kiln
