// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/plan/plan_file.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/errors.h"
#include "base/files.h"
#include "kiln/overrides.h"
#include "kiln/settings_layer.h"
#include "kiln/text_file.h"
#include "yaml/yaml_file.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

/// Quotes a value for YAML where plain text would be read as something else.
std::string yaml_text(const std::string& value) {
  const bool is_plain = !value.empty() && value.find_first_not_of(
                                              "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                              "0123456789.+-_/") == std::string::npos;
  if (is_plain && value.front() != '-') return value;
  std::string result = "\"";
  for (const char c : value) result += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return result + "\"";
}

std::string percent(double share) { return fmt::format("{:.3g} %", 100 * share); }

std::string block_of(const PlannedAsset& asset) {
  const std::string color = asset.color ? fmt::format("  # {}: {}.\n", asset.name, to_text(*asset.color)) : "";
  if (!asset.left_alone.empty())
    return fmt::format("  # {}: its settings stay as they are, for {}.\n", asset.name, asset.left_alone) + color;
  std::string text = color + fmt::format("  {}:\n", yaml_text(asset.name));
  text += fmt::format("    error: {:.4g}  # asked for; predicted {}\n", asset.asked, percent(asset.prediction.error));
  std::string stage;
  for (const PlanLine& line : asset.lines) {
    const std::size_t dot = line.setting.find('.');
    if (line.setting.substr(0, dot) != stage) {
      stage = line.setting.substr(0, dot);
      text += "    " + stage + ":\n";
    }
    const std::string entry = fmt::format("      {}: {}", line.setting.substr(dot + 1), yaml_text(line.value));
    text += line.reason.empty() ? entry + "\n" : fmt::format("{:<32}  # {}\n", entry, line.reason);
  }
  text += fmt::format("    predicted:  # of E, and what it costs: CPU seconds of the build, bytes that ship\n");
  text += fmt::format("      total: {:.4g}\n", asset.prediction.error);
  for (const auto& [cause, error] : asset.prediction.causes) text += fmt::format("      {}: {:.4g}\n", cause, error);
  text += fmt::format("      cpu_seconds: {:.3g}\n      bytes: {:.0f}\n", asset.prediction.cpu_seconds,
                      asset.prediction.bytes);
  if (asset.of_final)
    text += fmt::format(
        "      final_cpu_seconds: {:.3g}  # what the preset `final` would cost\n      final_bytes: {:.0f}\n",
        asset.of_final->cpu_seconds, asset.of_final->bytes);
  return text;
}

/// Returns `predicted` as kiln-report takes it.
std::string predictions_text(const YamlFile& file, const YAML::Node& asset, const std::string& asked) {
  std::string text = "asked=" + asked;
  const YAML::Node predicted = asset["predicted"];
  if (!predicted.IsDefined()) return text;
  file.check_keys(predicted, {});
  for (const auto& entry : predicted) text += "; " + entry.first.Scalar() + "=" + file.number(entry.second);
  return text;
}

void apply_to(Asset& asset, const YamlFile& file, const YAML::Node& body) {
  std::vector<std::string> known = names_of_blocks();
  known.insert(known.end(), {"error", "predicted"});
  file.check_keys(body, known);
  SettingsLayer layer;
  add_blocks(file, body, {}, layer);
  for (const auto& [stage, block] : layer.blocks) {
    if (block.on == false) {
      asset.settings.erase(stage);
      continue;
    }
    Overrides overrides;
    for (const auto& [name, setting] : block.settings) overrides.emplace_back(stage + "." + name, setting.text);
    override_settings(asset, overrides, file.where(body[stage]));
  }
  if (!body["error"].IsDefined()) return;
  const std::string asked = file.number(body["error"]);
  override_settings(asset, {{"report.predicted", predictions_text(file, body, asked)}}, file.where(body["error"]));
  std::erase_if(asset.budgets,
                [](const std::string& budget) { return budget.starts_with(std::string(error_metric) + "<="); });
  asset.budgets.push_back(std::string(error_metric) + "<=" + asked);
}

}  // namespace

void write_plan(const fs::path& file, const fs::path& pipeline, const std::vector<PlannedAsset>& assets,
                double pilot_seconds) {
  std::string text = fmt::format(
      "# What `kiln plan` chose, and why; `kiln build --plan {}` builds it. Every line may be changed.\n"
      "# Errors are E, the expected relighting error, as the report measures it. Pilots took {:.3g} CPU seconds.\n"
      "pipeline: {}\nassets:\n",
      file.filename().string(), pilot_seconds, yaml_text(pipeline.string()));
  for (const PlannedAsset& asset : assets) text += block_of(asset);
  if (std::ranges::all_of(assets, [](const PlannedAsset& asset) { return !asset.left_alone.empty(); }))
    text += "  {}\n";
  write_if_changed(file, text);
}

fs::path pipeline_of_plan(const fs::path& path) {
  const YamlFile file(path);
  file.check_keys(file.root(), {"pipeline", "assets"});
  const YAML::Node named = file.root()["pipeline"];
  file.require(named.IsDefined(), file.root(), "no 'pipeline'", "the file that the plan is for");
  const fs::path pipeline = file.path(named);
  return (pipeline.is_absolute() ? pipeline : folder_of(path) / pipeline).lexically_normal();
}

void apply_plan(Pipeline& pipeline, const fs::path& path) {
  const YamlFile file(path);
  file.check_keys(file.root(), {"pipeline", "assets"});
  const YAML::Node assets = file.root()["assets"];
  file.require(assets.IsDefined(), file.root(), "no 'assets'", "the assets that are planned");
  file.check_keys(assets, {});
  for (const auto& entry : assets) {
    const auto asset = std::ranges::find(pipeline.assets, entry.first.Scalar(), &Asset::name);
    file.require(asset != pipeline.assets.end(), entry.first, fmt::format("asset '{}'", entry.first.Scalar()),
                 fmt::format("assets of {}", pipeline.file.string()));
    apply_to(*asset, file, entry.second);
  }
}

}  // namespace kiln
