#pragma once

#include "base/stage_info.h"

namespace kiln {

/// The description of the atlas stage.
const StageInfo& atlas_stage();

}  // namespace kiln
