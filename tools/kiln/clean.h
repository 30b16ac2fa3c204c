// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "kiln/pipeline.h"

namespace kiln {

/// Removes what Kiln made of the named assets, or, where none are named, of all that it built in the output folder,
/// also of those that are no longer in the pipeline, with its own files there. Files that Kiln did not make are kept
/// and named. Throws WrongUsage for the name of an asset that is neither in the pipeline nor built.
void clean(const Pipeline& pipeline, const std::vector<std::string>& names, bool quiet);

}  // namespace kiln
