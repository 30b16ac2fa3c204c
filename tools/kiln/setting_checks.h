// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>

#include "kiln/pipeline.h"
#include "kiln/settings_layer.h"

namespace kiln {

/// Refuses combinations of settings that a stage would refuse, or that cannot work in a pipeline, although each is in
/// range. Throws BadInput that names where the setting stands.
void check_settings(const Asset& asset);

/// Refuses budgets for metrics that none of the asset's stages writes. Throws BadInput, with the nearest name.
void check_budgets(const Asset& asset, const std::map<std::string, Limits>& budgets);

/// Refuses a place in a scene that kiln-bake would refuse. Throws BadInput.
void check_place(const std::string& text, const std::string& asset, const std::string& place);

}  // namespace kiln
