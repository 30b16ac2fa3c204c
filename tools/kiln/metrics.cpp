// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/metrics.h"

#include <algorithm>
#include <string_view>

namespace kiln {

namespace {

/// Metrics of every stage, separated by blanks.
constexpr const char* of_every_stage = "seconds cpu_seconds peak_memory_bytes";

void add(std::vector<std::string>& metrics, const std::string& stage, std::string_view names) {
  while (!names.empty()) {
    const std::string_view name = names.substr(0, names.find(' '));
    metrics.push_back(stage + "." + std::string(name));
    names.remove_prefix(std::min(names.size(), name.size() + 1));
  }
}

}  // namespace

std::vector<std::string> metrics_of(const AssetSettings& settings) {
  std::vector<std::string> metrics;
  for (const StageInfo* stage : all_stages()) {
    if (!settings.contains(stage->name) || !stage->is_passed(settings)) continue;
    // The report's own CPU time and memory are not yet known when it judges.
    if (stage->name != "report") add(metrics, stage->name, of_every_stage);
    for (const MetricGroup& group : stage->metrics)
      if (group.is_written == nullptr || group.is_written(settings)) add(metrics, stage->name, group.names);
  }
  return metrics;
}

std::string setting_of_metric(const std::string& metric) {
  for (const StageInfo* stage : all_stages())
    for (const MetricGroup& group : stage->metrics)
      if (!group.prefix.empty() && metric.starts_with(stage->name + "." + group.prefix)) return group.setting;
  return "";
}

}  // namespace kiln
