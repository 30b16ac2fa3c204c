// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "kiln/plan/asset_model.h"

namespace kiln {

/// Cost that a plan makes least.
enum class PlanCost {
  both,     ///< the product of seconds and bytes: one may double where it halves the other
  seconds,  ///< CPU seconds of the build
  bytes     ///< bytes that ship
};

/// Limits that a choice keeps, and the cost that it makes least.
struct PlanGoal {
  double error = 0;  ///< E
  double bytes = std::numeric_limits<double>::infinity();
  double seconds = std::numeric_limits<double>::infinity();  ///< of the CPU
  PlanCost cost = PlanCost::both;
};

/// Returns a cost of a prediction.
double cost_of(const Prediction& prediction, PlanCost cost);

/// A choice and what it is predicted to be.
struct PlannedChoice {
  Choice choice;
  Prediction prediction;
};

/// Values that a plan considers for each setting.
struct ChoiceGrid {
  std::vector<int> triangles, sizes, bands, directions, bits;
  std::vector<bool> bounces;
  std::vector<bool> per_vertex = {false};
};

/// Returns the values that are worth a try for an asset: triangles from those of the coarse pilot to those of its high
/// mesh, in steps of the root of two, atlases of the coarse pilot's to 4,096 texels, as many bands as the pilot knows,
/// 64 to 32,768 directions, or no shadows where the pilot may be without, 8 and 16 bits, vertices in place of texels
/// where the pilot may be that. Below the coarse pilot errors rise faster than it can know.
ChoiceGrid full_grid(const AssetModel& model);

/// Returns every combination. `compression` is the E that kiln-compress may add in all of them, 0 for none.
std::vector<Choice> choices_of(const ChoiceGrid& grid, double compression);

/// Returns the cheapest choice that keeps the goal with its uncertainty to spare, a tenth of the error at least;
/// nothing where none does.
std::optional<PlannedChoice> cheapest(const AssetModel& model, const std::vector<Choice>& choices,
                                      const PlanGoal& goal);

/// Returns the choice of least error that keeps the goal's bytes and seconds; nothing where none does.
std::optional<PlannedChoice> most_accurate(const AssetModel& model, const std::vector<Choice>& choices,
                                           const PlanGoal& goal);

}  // namespace kiln
