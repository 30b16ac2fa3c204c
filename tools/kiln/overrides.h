// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "kiln/pipeline.h"

namespace kiln {

/// Settings over those of a pipeline: "bake.directions" and its text.
using Overrides = std::vector<std::pair<std::string, std::string>>;

/// Tells whether a setting, "simplify.faces", steers nothing of an asset because that brings its own low mesh.
bool is_moot(const Asset& asset, const std::string& name);

/// Gives an asset these settings; each removes those that it excludes, and a stage that the asset did not pass is
/// passed. Settings that are moot are left out. `source` says in messages where a setting stands, given its name.
void override_settings(Asset& asset, const Overrides& overrides, const std::string& source);

}  // namespace kiln
