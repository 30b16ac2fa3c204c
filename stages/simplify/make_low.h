// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "import/import_mesh.h"
#include "simplify/low_file.h"
#include "simplify/own_low.h"
#include "simplify/simplify_keeping.h"
#include "simplify/simplify_settings.h"

namespace kiln {

/// Makes the low mesh by the way that the settings ask for, and writes it: the user's own where `own_low` is given, or
/// a simplified one that keeps what settings.keep names. Appends to `warnings`.
KeepingResult make_low(const ImportedMesh& high, const OwnLow* own_low, const SimplifySettings& settings, LowFile& file,
                       std::vector<std::string>& warnings, const ProgressFunction& progress = no_progress);

}  // namespace kiln
