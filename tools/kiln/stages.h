// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/stage_info.h"

namespace kiln {

/// The stages that an asset passes, in this order. The list is that of CMake, KILN_STAGES.
std::span<const StageInfo* const> all_stages();

std::vector<std::string> stage_names();

/// The stage of that name, or null.
const StageInfo* find_stage(const std::string& name);

/// The same of a name that is known. Throws std::logic_error for others.
const StageInfo& stage_info(const std::string& name);

/// Where a stage stands among all; nothing for what is none, such as the making of a mesh.
std::optional<std::size_t> stage_position(const std::string& name);

/// What a setting is: the text that is given, or the default.
Json effective_setting(const AssetSettings& settings, const std::string& stage, const std::string& setting);

/// The runs of the stages that the asset passes, in order.
std::vector<StageRun> stage_runs(const AssetPlan& plan);

}  // namespace kiln
