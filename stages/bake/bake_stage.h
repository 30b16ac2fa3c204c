// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/stage_info.h"

namespace kiln {

/// The description of the bake stage.
const StageInfo& bake_stage();

}  // namespace kiln
