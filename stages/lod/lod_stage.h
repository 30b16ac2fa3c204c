// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/stage_info.h"

namespace kiln {

/// Describes the stage for the driver and other tools.
const StageInfo& lod_stage();

}  // namespace kiln
