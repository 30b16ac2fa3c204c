// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/settings_layer.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/files.h"
#include "import/import_settings.h"
#include "material/material_settings.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr int deepest_include = 16;

/// Reads the blocks of one mapping of one file.
class BlockReader {
 public:
  BlockReader(const YamlFile& file, const fs::path& prefix) : file_(file), prefix_(prefix) {}

  void read(const YAML::Node& map, SettingsLayer& layer) const {
    for (const StageInfo* stage : all_stages()) {
      const YAML::Node block = map[stage->name];
      if (!block.IsDefined()) continue;
      const bool is_switch = stage->on_request && block.IsScalar();
      file_.require(!is_switch || block.Scalar() == "true" || block.Scalar() == "false", block,
                    is_switch ? fmt::format("'{}'", block.Scalar()) : "",
                    fmt::format("true, false or settings of {}", stage->name));
      StageBlock& entry = layer.blocks[stage->name];
      entry.on = !is_switch || block.Scalar() == "true";
      if (block.IsSequence() && !stage->list_setting.empty()) {
        YAML::Node whole;  // `lod: [0.5, 0.25]` is `lod: {levels: [0.5, 0.25]}`
        whole[stage->list_setting] = block;
        entry.settings = stage_settings(*stage, whole);
      } else if (!is_switch && !block.IsNull())
        entry.settings = stage_settings(*stage, block);
    }
    if (const YAML::Node material = map["material"]) add_material(material, layer);
    if (const YAML::Node sizes = map["maps"]) add_map_sizes(sizes, layer);
    if (const YAML::Node block = map["import"]) add_import(block, layer);
  }

 private:
  /// Adds `import`: the first stage reads the mesh file by it, and its record passes it on to the others.
  void add_import(const YAML::Node& block, SettingsLayer& layer) const {
    ImportSettings import;
    OptionSet options;
    add_import_options(options, import);
    std::vector<std::string> names;
    for (const Option& option : options.options()) names.push_back(option.name);
    file_.check_keys(block, names);
    // Settings given for the stage itself take precedence.
    if (block.size() > 0) layer.blocks["simplify"].settings.merge(stage_settings(stage_info("simplify"), block));
  }

  /// Adds `material` to every stage that uses the surface's albedo and opacity.
  void add_material(const YAML::Node& block, SettingsLayer& layer) const {
    static const std::map<std::string, std::string> names = {{"albedo", "albedo"},
                                                             {"texture", "albedo-texture"},
                                                             {"reflectance", "reflectance"},
                                                             {"encoding", "albedo-encoding"},
                                                             {"opacity", "opacity"},
                                                             {"opacity-texture", "opacity-texture"},
                                                             {"opacity-cutoff", "opacity-cutoff"}};
    file_.check_keys(block,
                     {"albedo", "texture", "reflectance", "encoding", "opacity", "opacity-texture", "opacity-cutoff"});
    if (block.size() == 0) return;
    file_.require(!block["albedo"].IsDefined() || !block["texture"].IsDefined(), block, "both albedo and texture",
                  "one of them");
    for (const char* rival : {"albedo", "texture"})
      file_.require(!block["reflectance"].IsDefined() || !block[rival].IsDefined(), block,
                    std::string("both reflectance and ") + rival, "one of them");
    for (const StageInfo* stage : all_stages()) {
      if (stage->options().find("albedo-texture") == nullptr) continue;
      YAML::Node renamed;
      for (const auto& entry : block) renamed[names.at(entry.first.Scalar())] = entry.second;
      if (block["reflectance"].IsDefined() && block["reflectance"].IsMap()) {
        renamed.remove("reflectance");
        renamed["reflectance-of"] = reflectances_text(block["reflectance"]);
      }
      // Settings given for the stage itself take precedence.
      std::map<std::string, WrittenSetting> settings = stage_settings(*stage, renamed);
      // That text stands in no file.
      if (const auto made = settings.find("reflectance-of"); made != settings.end())
        made->second.where = file_.where(block["reflectance"]);
      layer.blocks[stage->name].settings.merge(std::move(settings));
    }
  }

  /// Turns reflectances by the names of materials into the text of an option, with paths as seen from the pipeline.
  std::string reflectances_text(const YAML::Node& map) const {
    file_.check_keys(map, {});
    file_.require(map.size() > 0, map, "no material", "names of materials, each with a file or TCS01 to TCS15");
    std::string text;
    for (const auto& entry : map) {
      const std::string name = entry.first.Scalar(), given = file_.scalar(entry.second, "a file or TCS01 to TCS15");
      const std::string value =
          is_test_sample(given) ? given : (prefix_ / file_.path(entry.second)).lexically_normal().string();
      for (const std::string& part : {name, value})
        file_.require(part.find_first_of(",=;") == std::string::npos, entry.first, "'" + part + "'",
                      "names of materials and files without commas, semicolons and equals signs");
      text += (text.empty() ? "" : ",") + name + "=" + value;
    }
    return text;
  }

  /// Adds `maps`, the sizes of what ships: the atlas is packed for the planes, whose size other maps have unless they
  /// are named.
  void add_map_sizes(const YAML::Node& block, SettingsLayer& layer) const {
    file_.check_keys(block, {"planes", "albedo", "normal"});
    const auto add = [&](const char* name, const char* stage, const char* setting) {
      if (!block[name].IsDefined()) return;
      YAML::Node renamed;
      renamed[setting] = block[name];
      // Settings given for the stage itself take precedence.
      layer.blocks[stage].settings.merge(stage_settings(stage_info(stage), renamed));
    };
    add("planes", "atlas", "size");
    add("albedo", "normals", "albedo-size");
    add("normal", "normals", "normal-size");
  }

  std::map<std::string, WrittenSetting> stage_settings(const StageInfo& stage, const YAML::Node& block) const {
    const StageOptions options = stage.options();
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
        throw BadInput(file_.where(entry.second), fmt::format("'{}' for {} of {}", text, option.name, stage.name),
                       option.is_switch ? "true or false" : option.value_range,
                       fmt::format("see kiln-{} --help", stage.name));
      }
      result[option.name] = {text, file_.where(entry.second)};
    }
    for (const auto& [name, setting] : result) {
      for (const std::string& rival : stage.rivals_of(name))
        if (result.contains(rival))
          throw BadInput(setting.where, fmt::format("both {} and {}", name, rival), "one of them", "remove the other");
    }
    return result;
  }

  /// Turns a setting into text; a list becomes one text, with semicolons, as on the command line.
  std::string setting_text(const Option& option, const YAML::Node& node) const {
    if (option.names_file && !(option.name == "reflectance" && node.IsScalar() && is_test_sample(node.Scalar())))
      return (prefix_ / file_.path(node)).lexically_normal().string();
    if (!node.IsSequence())
      return file_.scalar(node, option.value_range.empty() ? "true or false" : option.value_range);
    std::string text;
    for (const YAML::Node& item : node) text += (text.empty() ? "" : "; ") + file_.scalar(item, "a value");
    return text;
  }

  const YamlFile& file_;
  const fs::path& prefix_;
};

/// Reads included files and those that they include, `depth` files deep.
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
  names.emplace_back("material");
  names.emplace_back("maps");
  names.emplace_back("import");
  names.emplace_back("maps");
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
                             file.where(entry.first)};
  }
}

std::vector<SettingsLayer> included_layers(const YamlFile& file, const YAML::Node& include, const fs::path& prefix) {
  return layers_of(file, include, prefix, 1);
}

MergedSettings merge_layers(const std::vector<SettingsLayer>& layers, const std::string& asset) {
  MergedSettings merged;
  for (const StageInfo* stage : all_stages()) {
    bool passes = !stage->on_request;
    StageSettings settings, lines;
    for (const SettingsLayer& layer : layers) {
      const auto block = layer.blocks.find(stage->name);
      if (block == layer.blocks.end()) continue;
      if (stage->on_request) passes = block->second.on.value_or(passes);
      for (const auto& [name, setting] : block->second.settings) {
        for (const std::string& rival : stage->rivals_of(name)) settings.erase(rival);
        settings[name] = setting.text;
        lines[name] = setting.where;
      }
    }
    if (!passes) continue;
    merged.settings[stage->name] = std::move(settings);
    merged.lines[stage->name] = std::move(lines);
  }
  for (const SettingsLayer& layer : layers)
    for (const auto& [metric, limits] : layer.budgets) {
      const StageInfo* const info = find_stage(stage_of_metric(metric));
      if (layer.is_shared && info != nullptr && !info->is_passed(merged.settings)) continue;
      if (!merged.settings.contains(stage_of_metric(metric))) {
        const std::string stage = stage_of_metric(metric);
        throw BadInput(limits.where, fmt::format("a budget for '{}', and no {} of asset '{}'", metric, stage, asset),
                       fmt::format("'{}: true' or its settings beside it", stage), "change the line");
      }
      merged.budgets[metric] = limits;
    }
  return merged;
}

}  // namespace kiln
