// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "base/json_fwd.h"
#include "import/import_mesh.h"
#include "simplify/low_file.h"
#include "simplify/own_low.h"
#include "simplify/simplify.h"
#include "simplify/simplify_keeping.h"

namespace kiln {

/// Throws BadInput where a high mesh does not have what the settings ask of it; `file` is for the message.
void check_high(const ImportedMesh& high, const SimplifySettings& settings, const std::string& file);

/// Throws BadInput where the user's low mesh needs repair and the settings are strict.
void check_low(const OwnLow& low, const SimplifySettings& settings);

/// Returns the metrics of the stage's record; `own_low` is null where there is none.
Json metrics_of(const KeepingResult& kept, const ImportedMesh& high, const LowFile& low,
                const OwnLow* own_low = nullptr);

/// Returns what a user should know of a result: parts that were dropped, triangles too many, parts too far apart.
std::vector<std::string> warnings_of(const SimplifyResult& result, const LowFile& low);

}  // namespace kiln
