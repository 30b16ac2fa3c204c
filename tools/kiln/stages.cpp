// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/stages.h"

#include <stdexcept>

#include "base/json.h"

namespace kiln {

std::vector<std::string> stage_names() {
  std::vector<std::string> names;
  for (const StageInfo* stage : all_stages()) names.push_back(stage->name);
  return names;
}

const StageInfo* find_stage(const std::string& name) {
  for (const StageInfo* stage : all_stages())
    if (stage->name == name) return stage;
  return nullptr;
}

const StageInfo& stage_info(const std::string& name) {
  if (const StageInfo* stage = find_stage(name)) return *stage;
  throw std::logic_error("no stage " + name);
}

std::optional<std::size_t> stage_position(const std::string& name) {
  for (std::size_t k = 0; k < all_stages().size(); ++k)
    if (all_stages()[k]->name == name) return k;
  return std::nullopt;
}

Json effective_setting(const AssetSettings& settings, const std::string& stage, const std::string& setting) {
  const StageOptions options = stage_info(stage).options();
  const Option& option = *options.find(setting);
  const auto block = settings.find(stage);
  if (block != settings.end())
    if (const auto found = block->second.find(setting); found != block->second.end()) option.set(found->second);
  return option.get();
}

std::vector<StageRun> stage_runs(const AssetPlan& plan) {
  std::vector<StageRun> runs;
  for (const StageInfo* stage : all_stages())
    if (stage->is_passed(plan.settings)) runs.push_back(stage->run(plan));
  return runs;
}

}  // namespace kiln
