// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "bake/bake.h"
#include "bake/bake_scene.h"
#include "base/json.h"
#include "base/outputs.h"

namespace kiln {

class CommandLine;

/// Returns a warning if there are fewer directions than the bands need (directions_for_bands), else nothing.
std::vector<std::string> direction_warnings(const BakeSettings& settings);

/// Returns the job of baking a scene, without checkpoints and progress. `scene` outlives it.
BakeJob make_job(const BakeScene& scene, const BakeSettings& settings, const CommandLine& command);

/// Returns the metrics of bake.json that do not depend on the files written.
Json describe_bake(const BakeScene& scene, const BakeResult& result);

/// Writes the planes, ranges.json and copies of the mesh and the normal map (per vertex: ranges.json and the mesh that
/// holds the coefficients), so that the folder is all a runtime needs; reads the planes back and measures; verifies if
/// settings ask for it. Returns the metrics of bake.json.
Json save_bake(OutputSet& outputs, const BakePaths& paths, const BakeScene& scene, const BakeResult& result,
               const BakeSettings& settings, const CommandLine& command);

}  // namespace kiln
