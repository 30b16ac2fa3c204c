#pragma once

#include "base/stage_info.h"

namespace kiln {

/// The description of the report stage.
const StageInfo& report_stage();

}  // namespace kiln
