// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "asset/prt_asset.h"
#include "base/outputs.h"

namespace kiln {

/// Reads what kiln-lod wrote into `folder`, and checks that it is of this atlas file. Throws BadInput.
std::vector<PrtLevel> load_levels(const std::filesystem::path& folder, const std::filesystem::path& atlas_file);

/// Copies the levels' meshes to `outputs`, and has those of an earlier run removed.
void ship_levels(OutputSet& outputs, const std::filesystem::path& folder, const std::vector<PrtLevel>& levels);

}  // namespace kiln
