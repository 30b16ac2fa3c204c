// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/settings_layer.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/outputs.h"
#include "import/import_settings.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr int deepest_include = 16;

std::vector<std::string> stage_names() {
  std::vector<std::string> names;
  for (const Stage stage : all_stages) names.push_back(stage_name(stage));
  return names;
}

/// Reads the blocks of one mapping of one file.
class BlockReader {
 public:
  BlockReader(const YamlFile& file, const fs::path& prefix) : file_(file), prefix_(prefix) {}

  void read(const YAML::Node& map, SettingsLayer& layer) const {
    for (const Stage stage : all_stages) {
      const YAML::Node block = map[stage_name(stage)];
      if (!block.IsDefined()) continue;
      const bool is_switch = is_on_request(stage) && block.IsScalar();
      file_.require(!is_switch || block.Scalar() == "true" || block.Scalar() == "false", block,
                    is_switch ? fmt::format("'{}'", block.Scalar()) : "",
                    fmt::format("true, false or settings of {}", stage_name(stage)));
      StageBlock& entry = layer.blocks[stage];
      entry.on = !is_switch || block.Scalar() == "true";
      if (!is_switch && !block.IsNull()) entry.settings = stage_settings(stage, block);
    }
    if (const YAML::Node material = map["material"]) add_material(material, layer);
    if (const YAML::Node block = map["import"]) add_import(block, layer);
  }

 private:
  /// How the mesh file is read is for the first stage, whose record tells the others.
  void add_import(const YAML::Node& block, SettingsLayer& layer) const {
    ImportSettings import;
    OptionSet options;
    add_import_options(options, import);
    std::vector<std::string> names;
    for (const Option& option : options.options()) names.push_back(option.name);
    file_.check_keys(block, names);
    // Settings of the stage itself come first.
    if (block.size() > 0) layer.blocks[Stage::simplify].settings.merge(stage_settings(Stage::simplify, block));
  }

  /// What a surface reflects is for the normals stage, which makes a map of it, and for light that bounces in the bake.
  void add_material(const YAML::Node& block, SettingsLayer& layer) const {
    static const std::map<std::string, std::string> names = {
        {"albedo", "albedo"}, {"texture", "albedo-texture"}, {"encoding", "albedo-encoding"}};
    file_.check_keys(block, {"albedo", "texture", "encoding"});
    if (block.size() == 0) return;
    file_.require(!block["albedo"].IsDefined() || !block["texture"].IsDefined(), block, "both albedo and texture",
                  "one of them");
    for (const Stage stage : {Stage::normals, Stage::bake}) {
      YAML::Node renamed;
      for (const auto& entry : block) renamed[names.at(entry.first.Scalar())] = entry.second;
      // Settings of the stage itself come first.
      layer.blocks[stage].settings.merge(stage_settings(stage, renamed));
    }
  }

  std::map<std::string, WrittenSetting> stage_settings(Stage stage, const YAML::Node& block) const {
    const StageOptions options(stage);
    std::vector<std::string> known;
    for (const Option& option : options.all()) known.push_back(option.name);
    file_.check_keys(block, known);
    std::map<std::string, WrittenSetting> result;
    for (const auto& entry : block) {
      const Option& option = *options.find(entry.first.Scalar());
      const std::string text = setting_text(option, entry.second);
      try {
        option.set(text);
      } catch (const WrongUsage&) {
        throw BadInput(file_.place(entry.second),
                       fmt::format("'{}' for {} of {}", text, option.name, stage_name(stage)),
                       option.is_switch ? "true or false" : option.value_range,
                       fmt::format("see kiln-{} --help", stage_name(stage)));
      }
      result[option.name] = {text, file_.place(entry.second)};
    }
    for (const auto& [name, setting] : result) {
      const std::string rival = rival_of(stage, name);
      if (rival.empty() || !result.contains(rival)) continue;
      throw BadInput(setting.place, fmt::format("both {} and {}", name, rival), "one of them", "remove the other");
    }
    return result;
  }

  /// A list becomes one text, with semicolons, as the command line has it.
  std::string setting_text(const Option& option, const YAML::Node& node) const {
    if (names_a_file(option.name)) return (prefix_ / file_.path(node)).lexically_normal().string();
    if (!node.IsSequence())
      return file_.scalar(node, option.value_range.empty() ? "true or false" : option.value_range);
    std::string text;
    for (const YAML::Node& item : node) text += (text.empty() ? "" : "; ") + file_.scalar(item, "a value");
    return text;
  }

  const YamlFile& file_;
  const fs::path& prefix_;
};

/// Includes of includes, `depth` files deep.
std::vector<SettingsLayer> layers_of(const YamlFile& file, const YAML::Node& include, const fs::path& prefix,
                                     int depth) {
  file.require(include.IsScalar() || include.IsSequence(), include, "not a path", "a path, or a list of them");
  file.require(depth <= deepest_include, include, "files that include one another", "an end of it");
  std::vector<YAML::Node> nodes;
  if (include.IsScalar()) nodes.push_back(include);
  if (include.IsSequence())
    for (const YAML::Node& node : include) nodes.push_back(node);
  std::vector<SettingsLayer> layers;
  for (const YAML::Node& node : nodes) {
    const fs::path named = file.path(node), path = named.is_absolute() ? named : folder_of(file.file()) / named;
    std::error_code error;
    file.require(fs::is_regular_file(path, error), node, "'" + named.string() + "', which is no file",
                 "a file of defaults and budgets");
    const YamlFile inner(path.lexically_normal());
    const fs::path inner_prefix = (prefix / named).parent_path().lexically_normal();
    inner.check_keys(inner.root(), {"defaults", "budgets", "include"});
    if (const YAML::Node more = inner.root()["include"]) {
      std::vector<SettingsLayer> weaker = layers_of(inner, more, inner_prefix, depth + 1);
      layers.insert(layers.end(), weaker.begin(), weaker.end());
    }
    SettingsLayer& layer = layers.emplace_back();
    layer.is_shared = true;
    if (const YAML::Node blocks = inner.root()["defaults"]) {
      inner.check_keys(blocks, names_of_blocks());
      add_blocks(inner, blocks, inner_prefix, layer);
    }
    if (const YAML::Node budgets = inner.root()["budgets"]) add_budgets(inner, budgets, layer);
  }
  return layers;
}

std::string stage_of_metric(const std::string& metric) { return metric.substr(0, metric.find('.')); }

}  // namespace

std::vector<std::string> names_of_blocks() {
  std::vector<std::string> names = stage_names();
  names.push_back("material");
  names.push_back("import");
  return names;
}

void add_blocks(const YamlFile& file, const YAML::Node& map, const fs::path& prefix, SettingsLayer& layer) {
  BlockReader(file, prefix).read(map, layer);
}

void add_budgets(const YamlFile& file, const YAML::Node& block, SettingsLayer& layer) {
  file.check_keys(block, {});
  for (const auto& entry : block) {
    const std::string metric = entry.first.Scalar();
    const std::string stage = stage_of_metric(metric);
    const std::vector<std::string> stages = stage_names();
    file.require(std::find(stages.begin(), stages.end(), stage) != stages.end() && stage.size() + 1 < metric.size(),
                 entry.first, fmt::format("a budget for '{}'", metric),
                 fmt::format("STAGE.METRIC with a stage of {}", fmt::join(stages, ", ")));
    file.check_keys(entry.second, {"max", "min"});
    file.require(entry.second.size() > 0, entry.second, "no limit", "max, min or both");
    layer.budgets[metric] = {file.number(entry.second["min"]), file.number(entry.second["max"]),
                             file.place(entry.first)};
  }
}

std::vector<SettingsLayer> included_layers(const YamlFile& file, const YAML::Node& include, const fs::path& prefix) {
  return layers_of(file, include, prefix, 1);
}

MergedSettings merge_layers(const std::vector<SettingsLayer>& layers, const std::string& asset) {
  MergedSettings merged;
  for (const Stage stage : all_stages) {
    bool passes = !is_on_request(stage);
    StageSettings settings, places;
    for (const SettingsLayer& layer : layers) {
      const auto block = layer.blocks.find(stage);
      if (block == layer.blocks.end()) continue;
      if (is_on_request(stage)) passes = block->second.on.value_or(passes);
      for (const auto& [name, setting] : block->second.settings) {
        settings.erase(rival_of(stage, name));
        settings[name] = setting.text;
        places[name] = setting.place;
      }
    }
    if (!passes) continue;
    merged.settings[stage] = std::move(settings);
    merged.places[stage] = std::move(places);
  }
  const auto passes_stage_of = [&](const std::string& metric) {
    return std::any_of(merged.settings.begin(), merged.settings.end(),
                       [&](const auto& entry) { return stage_name(entry.first) == stage_of_metric(metric); });
  };
  for (const SettingsLayer& layer : layers)
    for (const auto& [metric, limits] : layer.budgets) {
      if (!passes_stage_of(metric)) {
        if (layer.is_shared) continue;
        const std::string stage = stage_of_metric(metric);
        throw BadInput(limits.place, fmt::format("a budget for '{}', and no {} of asset '{}'", metric, stage, asset),
                       fmt::format("'{}: true' or its settings beside it", stage), "change the line");
      }
      merged.budgets[metric] = limits;
    }
  return merged;
}

}  // namespace kiln
