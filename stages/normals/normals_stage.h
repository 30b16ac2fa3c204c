// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/stage_info.h"

namespace kiln {

/// The description of the normals stage.
const StageInfo& normals_stage();

}  // namespace kiln
