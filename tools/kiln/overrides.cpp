// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/overrides.h"

#include "kiln/setting_checks.h"

namespace kiln {

bool is_moot(const Asset& asset, const std::string& name) {
  const auto simplify = asset.settings.find("simplify");
  if (simplify == asset.settings.end() || !simplify->second.contains("low")) return false;
  for (const std::string& rival : stage_info("simplify").rivals_of("low"))
    if (name == "simplify." + rival) return true;
  return false;
}

void override_settings(Asset& asset, const Overrides& overrides, const std::string& source) {
  for (const auto& [name, value] : overrides) {
    if (is_moot(asset, name)) continue;
    const std::size_t dot = name.find('.');
    const std::string stage = name.substr(0, dot), setting = name.substr(dot + 1);
    StageSettings& settings = asset.settings[stage];
    for (const std::string& rival : stage_info(stage).rivals_of(setting)) settings.erase(rival);
    settings[setting] = value;
    asset.setting_lines[stage][setting] = source + " " + name;
  }
  check_settings(asset);
}

}  // namespace kiln
