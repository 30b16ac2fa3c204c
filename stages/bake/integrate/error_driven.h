// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bake/bake_settings.h"
#include "bake/engines/transfer_engine.h"

namespace kiln {

struct DirectionChoice {
  int directions = 0;
  double estimated_error = 0;  ///< of integration alone, relative L2
  double target_error = 0;
};

/// Bakes a sample of the receivers by `engine` over growing prefixes of the progressive directions, until the estimated
/// error of a prefix is under the target or settings.max_directions is reached. The estimate is half the distance
/// between the mean of one half of the directions and that of the other, over 1.15: on synthetic occluders that half is
/// 1.15 to 1.95 times the true error (sh/directions.h).
DirectionChoice choose_directions(TransferEngine& engine, const Receivers& sample, const BakeSettings& settings,
                                  const ErrorTarget& target, int seed, const ProgressFunction& progress);

}  // namespace kiln
