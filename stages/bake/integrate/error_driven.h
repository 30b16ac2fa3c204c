// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bake/bake_job.h"
#include "bake/bake_reports.h"
#include "bake/engines/transfer_engine.h"

namespace kiln {

/// Bakes a sample of the job's receivers by `engine` over growing prefixes of the progressive directions, until the
/// estimated error of a prefix is under settings.max_error or settings.max_directions is reached. The estimate is half
/// the distance between the mean of one half of the directions and that of the other, over 1.15: on synthetic occluders
/// that half is 1.15 to 1.95 times the true error (sh/directions.h).
DirectionChoice choose_directions(TransferEngine& engine, const Receivers& sample, const BakeJob& job);

}  // namespace kiln
