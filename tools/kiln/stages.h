// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/stage_info.h"

namespace kiln {

/// Lists the stages that an asset passes, in order: those of KILN_STAGES in CMakeLists.txt.
std::span<const StageInfo* const> all_stages();

std::vector<std::string> stage_names();

/// Finds a stage by name; null if there is none.
const StageInfo* find_stage(const std::string& name);

/// Finds a stage by a name that must exist. Throws std::logic_error otherwise.
const StageInfo& stage_info(const std::string& name);

/// Returns the position of a stage among all; nothing for other steps, such as the making of a mesh.
std::optional<std::size_t> stage_position(const std::string& name);

/// Returns the value of a setting: the text that is given, or the default.
Json effective_setting(const AssetSettings& settings, const std::string& stage, const std::string& setting);

/// Lists the runs of the stages that the asset passes, in order.
std::vector<StageRun> stage_runs(const AssetPlan& plan);

}  // namespace kiln
