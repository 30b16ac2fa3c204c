// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kiln/stages.h"
#include "kiln/yaml_file.h"

namespace kiln {

/// A setting's text, and where it stands: "FILE:LINE".
struct WrittenSetting {
  std::string text;
  std::string where;
};

/// What one mapping of a file says of one stage.
struct StageBlock {
  std::map<std::string, WrittenSetting> settings;
  std::optional<bool> on;  ///< of a stage on request: whether assets pass it
};

/// The lowest and highest that a metric may be, as texts, empty for none.
struct Limits {
  std::string lowest, highest;
  std::string where;
};

/// Settings and budgets that stand together: the defaults of a pipeline, a file that is included, one asset's own.
struct SettingsLayer {
  std::map<std::string, StageBlock> blocks;  ///< by stage
  std::map<std::string, Limits> budgets;     ///< by "STAGE.METRIC"
  bool is_shared = false;                    ///< by assets, which need not pass the stages of its budgets
};

/// Settings after all layers, the defaults left out.
struct MergedSettings {
  AssetSettings settings;
  AssetSettings lines;                    ///< where each of them stands
  std::map<std::string, Limits> budgets;  ///< without those that are for all assets and of a stage not passed
};

/// The keys of a mapping that add_blocks() reads: the stages, material and import.
std::vector<std::string> names_of_blocks();

/// Reads the blocks of stages, `material` and `import` of `map`. Paths in them, which are relative to the file's
/// folder, become relative to that of the pipeline: `prefix` is the former seen from the latter. Throws BadInput.
void add_blocks(const YamlFile& file, const YAML::Node& map, const std::filesystem::path& prefix, SettingsLayer& layer);

/// Reads the mapping `budgets`.
void add_budgets(const YamlFile& file, const YAML::Node& block, SettingsLayer& layer);

/// Reads the files that `include` of a mapping names, a path or a list of them, and those that they include: each with
/// `defaults`, `budgets` and `include` alone. Gives their layers, the weaker ones first. `prefix` as above.
std::vector<SettingsLayer> included_layers(const YamlFile& file, const YAML::Node& include,
                                           const std::filesystem::path& prefix);

/// The layers on top of one another, the last the strongest; a setting drives out its rival of weaker ones. An
/// asset must pass the stages of those budgets that are its own alone. Throws BadInput.
MergedSettings merge_layers(const std::vector<SettingsLayer>& layers, const std::string& asset);

}  // namespace kiln
