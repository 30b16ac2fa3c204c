// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "kiln/pipeline.h"

namespace kiln {

/// Removes Kiln's files of the named assets. Without names, removes everything that it built in the output folder,
/// including assets that are no longer in the pipeline and its own files there. Files that Kiln did not make are kept
/// and named. Throws WrongUsage for an asset that is neither in the pipeline nor built.
void clean(const Pipeline& pipeline, const std::vector<std::string>& names, bool quiet);

}  // namespace kiln
