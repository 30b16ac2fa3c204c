// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kiln/stages.h"
#include "yaml/yaml_file.h"

namespace kiln {

/// A setting's text, and where it stands: "FILE:LINE".
struct WrittenSetting {
  std::string text;
  std::string where;
};

/// Settings of one stage in one mapping of a file.
struct StageBlock {
  std::map<std::string, WrittenSetting> settings;
  std::optional<bool> on;  ///< of a stage on request: whether assets pass it
};

/// Lowest and highest allowed value of a metric, as texts; empty for none.
struct Limits {
  std::string lowest, highest;
  std::string where;
};

/// Settings and budgets that stand together: the defaults of a pipeline, an included file, or one asset's own.
struct SettingsLayer {
  std::map<std::string, StageBlock> blocks;  ///< by stage
  std::map<std::string, Limits> budgets;     ///< by "STAGE.METRIC"
  bool is_shared = false;  ///< whether several assets share it, which need not pass the stages of its budgets
};

/// Settings after all layers, without the defaults.
struct MergedSettings {
  AssetSettings settings;
  AssetSettings lines;                    ///< where each setting stands
  std::map<std::string, Limits> budgets;  ///< without shared budgets for stages that the asset does not pass
};

/// Lists the keys of a mapping that add_blocks() reads: the stages, material and import.
std::vector<std::string> names_of_blocks();

/// Reads the blocks of stages, `material` and `import` of `map`. Paths in them, which are relative to the file's
/// folder, are made relative to the pipeline's: `prefix` is the former seen from the latter. Throws BadInput.
void add_blocks(const YamlFile& file, const YAML::Node& map, const std::filesystem::path& prefix, SettingsLayer& layer);

/// Reads the mapping `budgets`.
void add_budgets(const YamlFile& file, const YAML::Node& block, SettingsLayer& layer);

/// Reads the files that `include` of a mapping names, a path or a list of them, and those that they include; each may
/// have only `defaults`, `budgets` and `include`. Returns their layers, the weaker ones first. `prefix` is as for
/// add_blocks.
std::vector<SettingsLayer> included_layers(const YamlFile& file, const YAML::Node& include,
                                           const std::filesystem::path& prefix);

/// Merges layers, of which the last is the strongest; a setting removes excluded ones of weaker layers. An asset must
/// pass the stages of its own budgets, not those of shared ones. Throws BadInput.
MergedSettings merge_layers(const std::vector<SettingsLayer>& layers, const std::string& asset);

}  // namespace kiln
