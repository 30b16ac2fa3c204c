// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/presets.h"

#include <algorithm>

namespace kiln {

std::span<const Preset> all_presets() {
  static const Preset presets[] = {
      {"draft",
       "to look at while one works",
       0.15,
       {{"simplify.faces", "2000"},
        {"simplify.quality", "standard"},
        {"atlas.size", "128"},
        {"bake.bands", "5"},
        {"bake.directions", "256"}}},
      {"standard",
       "for most assets",
       0.1,
       {{"simplify.faces", "2000"},
        {"simplify.quality", "standard"},
        {"atlas.size", "256"},
        {"bake.bands", "8"},
        {"bake.directions", "256"}}},
      {"final",
       "for heroes, seen from near",
       0.07,
       {{"simplify.faces", "8000"},
        {"simplify.quality", "standard"},
        {"atlas.size", "512"},
        {"bake.bands", "8"},
        {"bake.directions", "1024"}}},
  };
  return presets;
}

const Preset* find_preset(const std::string& name) {
  const std::span<const Preset> presets = all_presets();
  const auto found = std::ranges::find(presets, name, &Preset::name);
  return found == presets.end() ? nullptr : &*found;
}

SettingsLayer preset_layer(const Preset& preset, const std::string& where) {
  SettingsLayer layer;
  layer.is_shared = true;
  for (const auto& [name, value] : preset.settings) {
    const std::size_t dot = name.find('.');
    layer.blocks[name.substr(0, dot)].settings[name.substr(dot + 1)] = {value, where};
  }
  return layer;
}

}  // namespace kiln
