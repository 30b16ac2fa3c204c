// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/report_command.h"

#include <cstdio>
#include <fmt/format.h>

#include "base/errors.h"
#include "kiln/gate/comparison_page.h"
#include "kiln/gate/gate.h"
#include "kiln/gate/junit.h"
#include "kiln/gate/markdown.h"
#include "kiln/text_file.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

fs::path output_of(const Pipeline& pipeline) { return pipeline.folder / pipeline.output; }

Gate gate_of(const Pipeline& pipeline) {
  Gate gate;
  gate.pipeline = fs::absolute(output_of(pipeline)).lexically_normal().filename().string();
  if (gate.pipeline.empty()) gate.pipeline = "assets";
  return gate;
}

/// Returns why an asset is not built; empty if it is.
std::string fault_of(const AssetOutcome& outcome) {
  if (!outcome.error.empty()) return outcome.error;
  for (const StageOutcome& stage : outcome.stages)
    if (stage.state == "failed") return fmt::format("{} failed with exit status {}", stage.stage, stage.status);
  for (const StageOutcome& stage : outcome.stages)
    if (stage.state == "not reached") return fmt::format("{} was not reached", stage.stage);
  return outcome.stages.empty() ? "was not built, because another asset cannot be" : "";
}

/// Compares all assets that are in the baseline, and checks that there is one.
void compare(Gate& gate, const fs::path& output, const fs::path& baseline) {
  const fs::path pictures = output / comparison_folder;
  fs::remove_all(pictures);
  fs::create_directories(pictures);
  std::size_t compared = 0;
  for (AssetGate& asset : gate.assets) {
    if (!asset.metrics.is_object()) continue;
    const std::optional<BaselineFolder> found = find_baseline(baseline, asset.name);
    if (!found) continue;
    compare_with_baseline(asset, output / asset.name, *found, pictures, gate.settings);
    ++compared;
  }
  if (compared == 0)
    gate.faults.push_back(
        fmt::format("no asset of this build is in the baseline {}; nothing was compared", baseline.string()));
}

void save(const Gate& gate, const fs::path& output, bool always) {
  write_if_changed(output / junit_file, junit_xml(gate));
  write_if_changed(output / summary_file, summary_markdown(gate, always));
  if (!gate.has_baseline) return;
  write_if_changed(output / comparison_file, comparison_html(gate));
  write_if_changed(output / comparison_data_file, json_text(to_json(gate), 2) + "\n");
}

void tell(const Gate& gate) {
  for (const std::string& fault : gate.faults) std::fprintf(stderr, "kiln: %s\n", fault.c_str());
  for (const AssetGate& asset : gate.assets) {
    for (const std::string& fault : {asset.fault, asset.picture_fault})
      if (!fault.empty()) std::fprintf(stderr, "kiln: asset '%s' %s\n", asset.name.c_str(), fault.c_str());
    for (const BudgetVerdict& verdict : asset.budgets)
      if (!verdict.met)
        std::fprintf(stderr, "kiln: asset '%s' misses a budget: %s: %s\n", asset.name.c_str(),
                     verdict.budget.metric.c_str(), verdict_text(asset, verdict).c_str());
  }
}

}  // namespace

int report_on(const Pipeline& pipeline, const std::vector<const Asset*>& assets, const ReportCommand& settings) {
  const fs::path output = output_of(pipeline);
  std::error_code error;
  if (!fs::is_directory(output, error))
    throw BadInput(output.string(), "is no folder", "the output folder of a build", "run 'kiln build' first");
  if (!settings.baseline.empty() && !fs::exists(settings.baseline, error))
    throw BadInput(settings.baseline.string(), "does not exist", "a metrics.json or a folder of an earlier build",
                   "name another one, or leave --baseline out");
  Gate gate = gate_of(pipeline);
  for (const Asset* asset : assets) gate.assets.push_back(read_asset_gate(asset->name, output / asset->name));
  gate.has_baseline = !settings.baseline.empty();
  gate.settings.same_run = settings.same_run;
  if (gate.assets.empty()) gate.faults.emplace_back("there is no asset to report on");
  if (gate.has_baseline) compare(gate, output, settings.baseline);
  save(gate, output, settings.always);
  tell(gate);
  if (settings.json) std::printf("%s\n", json_text(to_json(gate)).c_str());
  if (!settings.quiet)
    std::fprintf(stderr, "kiln: wrote %s\n",
                 (output / (gate.has_baseline ? comparison_file : junit_file)).lexically_normal().string().c_str());
  return static_cast<int>(gate.failures() > 0 ? ExitCode::budget_missed : ExitCode::done);
}

void write_gate_files(const Pipeline& pipeline, const std::vector<AssetOutcome>& outcomes) {
  const fs::path output = output_of(pipeline);
  Gate gate = gate_of(pipeline);
  for (const AssetOutcome& outcome : outcomes) {
    const std::string fault = fault_of(outcome);
    if (fault.empty()) {
      gate.assets.push_back(read_asset_gate(outcome.name, output / outcome.name));
      continue;
    }
    AssetGate& asset = gate.assets.emplace_back();
    asset.name = outcome.name;
    asset.fault = fault;
  }
  save(gate, output, false);
}

void remove_gate_files(const Pipeline& pipeline) {
  std::error_code error;
  for (const char* name : {junit_file, summary_file}) fs::remove(output_of(pipeline) / name, error);
}

}  // namespace kiln
