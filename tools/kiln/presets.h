// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "kiln/overrides.h"
#include "kiln/settings_layer.h"

namespace kiln {

/// Settings that belong together: a point of the front that docs/tradeoffs.md measured.
struct Preset {
  std::string_view name;
  std::string_view purpose;
  double error;        ///< E that it promises of a scan, under the measured prior
  Overrides settings;  ///< "bake.directions" and its text
};

/// Returns all presets, the cheapest first.
std::span<const Preset> all_presets();

/// Returns the preset of a name; null if there is none.
const Preset* find_preset(const std::string& name);

/// Returns a preset's settings as a layer; `where` is the line that asks for it.
SettingsLayer preset_layer(const Preset& preset, const std::string& where);

}  // namespace kiln
