// SPDX-License-Identifier: MIT
#include "base/stage_info.h"

#include <cctype>

namespace kiln {

bool bakes_vertices(const AssetSettings& settings) {
  const auto bake = settings.find("bake");
  if (bake == settings.end()) return false;
  const auto found = bake->second.find("per-vertex");
  return found != bake->second.end() && found->second == "true";
}

void StageOptions::add_seed(OptionSet& options, int& seed) {
  options.integer("seed", seed, 0, 2147483647, "Seed of everything random");
}

void StageRun::add_settings(const StageOptions& options, const StageSettings& given) {
  for (const Option& option : options.all()) {
    const auto found = given.find(option.name);
    if (found == given.end() || (option.is_switch && found->second == "false")) continue;
    const std::string& value = found->second;
    const bool looks_like_option = value.size() > 1 && value[0] == '-' && std::isalpha(value[1]) != 0;
    command.push_back("--" + option.name + (looks_like_option ? "=" + value : ""));
    if (!option.is_switch && !looks_like_option) command.push_back(value);
  }
}

std::vector<std::string> StageRun::whole_command() const {
  std::vector<std::string> whole = command;
  whole.insert(whole.end(), limits.begin(), limits.end());
  return whole;
}

const StageSettings& AssetPlan::settings_of(const std::string& stage) const {
  static const StageSettings none;
  const auto found = settings.find(stage);
  return found == settings.end() ? none : found->second;
}

bool StageInfo::is_passed(const AssetSettings& settings) const {
  return (!on_request || settings.contains(name)) && !(for_texels && bakes_vertices(settings));
}

std::vector<std::string> StageInfo::rivals_of(const std::string& setting) const {
  std::vector<std::string> found;
  for (const auto& [one, other] : rivals) {
    if (one == setting) found.push_back(other);
    if (other == setting) found.push_back(one);
  }
  return found;
}

std::string command_word(const std::filesystem::path& path) {
  return (path.native().starts_with('-') ? "./" : "") + path.native();
}

std::string folder_word(const std::filesystem::path& path) { return path.string() + "/"; }

}  // namespace kiln
