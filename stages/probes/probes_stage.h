// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/stage_info.h"

namespace kiln {

/// The description of the probes stage, which an asset passes on request. In pipeline.yaml it takes `points` as well, a
/// file of points in place of a grid.
const StageInfo& probes_stage();

}  // namespace kiln
