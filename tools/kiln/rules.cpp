// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/rules.h"

#include <fmt/format.h>

#include "base/errors.h"
#include "import/import_settings.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

fs::path high_mesh_of(const Pipeline& pipeline, const Asset& asset) {
  const fs::path made = pipeline.output / asset.name / "high";
  if (!asset.square.empty()) return made / "square.obj";
  return asset.archive.empty() ? asset.mesh : made / fs::path(asset.member).filename();
}

/// Writes a field of --neighbour, with a backslash before its own semicolons and backslashes.
std::string field_text(const std::string& text) {
  std::string field;
  for (const char c : text) {
    if (c == ';' || c == '\\') field += '\\';
    field += c;
  }
  return field;
}

/// Describes an asset as kiln-bake's --neighbour expects it.
std::string neighbour_text(const fs::path& mesh, const std::string& place, const Asset& asset) {
  std::string text = fmt::format("{};place={}", field_text(command_word(mesh)), place);
  const auto add = [&](const char* stage, const char* name) {
    const auto settings = asset.settings.find(stage);
    if (settings == asset.settings.end()) return;
    const auto found = settings->second.find(name);
    if (found == settings->second.end()) return;
    std::string value = found->second;
    for (std::size_t k; (k = value.find("; ")) != std::string::npos;) value.replace(k, 2, ",");  // separators of a list
    text += fmt::format(";{}={}", name, field_text(value));
  };
  for (const char* name : {"albedo", "albedo-texture", "reflectance", "reflectance-of", "albedo-encoding", "opacity",
                           "opacity-texture", "opacity-cutoff"})
    add("normals", name);
  ImportSettings import;
  OptionSet import_options;
  add_import_options(import_options, import);
  for (const Option& option : import_options.options()) add("simplify", option.name.c_str());
  return text;
}

/// Lists the assets that stand in the same scene as `asset`.
std::vector<PlanNeighbour> neighbours_of(const Pipeline& pipeline, const Asset& asset) {
  std::vector<PlanNeighbour> neighbours;
  if (!pipeline.places.contains(asset.name)) return neighbours;
  for (const Asset& other : pipeline.assets) {
    const auto place = pipeline.places.find(other.name);
    if (other.name == asset.name || place == pipeline.places.end()) continue;
    const fs::path mesh = high_mesh_of(pipeline, other);
    neighbours.push_back({mesh, neighbour_text(mesh, place->second, other)});
  }
  return neighbours;
}

AssetPlan plan_of(const Pipeline& pipeline, const Asset& asset) {
  AssetPlan plan;
  plan.folder = pipeline.output / asset.name;
  plan.mesh = high_mesh_of(pipeline, asset);
  plan.settings = asset.settings;
  plan.budgets = asset.budgets;
  if (const auto place = pipeline.places.find(asset.name); place != pipeline.places.end()) plan.place = place->second;
  plan.neighbours = neighbours_of(pipeline, asset);
  return plan;
}

}  // namespace

std::vector<MakeRule> make_rules(const Pipeline& pipeline) {
  std::vector<MakeRule> rules;
  for (const Asset& asset : pipeline.assets) {
    const AssetPlan plan = plan_of(pipeline, asset);
    std::vector<StageRun> runs;
    if (!asset.square.empty())
      runs.push_back({"square", {"kiln", "square", asset.square, "-o", plan.mesh.string()}, {}, {}, {plan.mesh}});
    if (!asset.archive.empty())
      runs.push_back({"extract",
                      {"kiln", "extract", "-o", plan.mesh.string(), "--", asset.archive.string(), asset.member},
                      {},
                      {asset.archive},
                      {plan.mesh}});
    for (StageRun& run : stage_runs(plan)) runs.push_back(std::move(run));
    const fs::path notes = pipeline.output / ".kiln" / asset.name;
    for (StageRun& run : runs) {
      const std::string name = run.name;
      rules.push_back({asset.name, std::move(run), notes / (name + ".plan.json"), notes / (name + ".state.json")});
    }
  }
  return rules;
}

std::string stamp_text(const StageRun& run, FileHashes& programs) {
  std::string text;
  for (const std::string& word : run.command) text += (text.empty() ? "" : " ") + shell_quoted(word);
  text += fmt::format("\nversion {}\n", KILN_VERSION);
  std::vector<std::string> names = {run.command.front()};
  names.insert(names.end(), run.helpers.begin(), run.helpers.end());
  for (const std::string& name : names) {
    if (name == "kiln") continue;  // kiln only extracts meshes; its effect on assets is in the commands
    const std::optional<FileStamp> stamp = programs.stamp(name);
    if (!stamp) throw MachineLacks(fmt::format("{} is not beside kiln; build it: make build", name));
    text += fmt::format("{} {}\n", name, stamp->hash);
  }
  return text;
}

}  // namespace kiln
