// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/options.h"

namespace kiln {

/// The stages that an asset passes, in this order.
enum class Stage { simplify, atlas, normals, bake, compress, report };

inline constexpr Stage all_stages[] = {Stage::simplify, Stage::atlas,    Stage::normals,
                                       Stage::bake,     Stage::compress, Stage::report};

/// Whether an asset passes the stage only where pipeline.yaml has a block for it.
bool is_on_request(Stage stage);

/// As pipeline.yaml and the executables call it.
std::string stage_name(Stage stage);

/// What pipeline.yaml says of one stage: the text of each setting by its name, the defaults left out.
using StageSettings = std::map<std::string, std::string>;

/// The settings of a stage as its executable knows them, with their defaults, and --seed.
class StageOptions {
 public:
  explicit StageOptions(Stage stage);

  const std::vector<Option>& all() const { return options_.options(); }
  const Option* find(const std::string& name) const { return options_.find(name); }

 private:
  std::shared_ptr<void> storage_;  // what options_ is bound to
  OptionSet options_;
};

/// Settings of which a stage takes one: with both given, the more specific place wins. Empty where there is no rival.
std::string rival_of(Stage stage, const std::string& setting);

/// Whether a setting's text is the path of a file.
bool names_a_file(const std::string& setting);

/// What a setting is: the text that is given, or the default.
Json effective_setting(const std::map<Stage, StageSettings>& settings, Stage stage, const std::string& setting);

/// A path as a word of a command that does not look like an option.
std::string command_word(const std::filesystem::path& path);

/// One stage of one asset as make runs it. Paths are as the command has them.
struct StageRun {
  std::string name;                  ///< of the stage
  std::vector<std::string> command;  ///< program (a bare name, found beside kiln) and arguments
  std::vector<std::string> helpers;  ///< further programs it runs
  std::vector<std::filesystem::path> inputs;
  std::vector<std::filesystem::path> outputs;  ///< the record, <stage>.json, first
  std::filesystem::path checkpoint;            ///< a folder; where it is there, the stage goes on with --resume
  std::vector<std::string> limits = {};        ///< more arguments, the budgets of a report: others alone judge it anew

  /// `command` and `limits`.
  std::vector<std::string> whole_command() const;
};

/// Another asset of the scene, as the bake of one is told of it.
struct PlanNeighbour {
  std::filesystem::path mesh;
  std::string text;  ///< the value of kiln-bake's --neighbour
};

/// What one asset is made of and how.
struct AssetPlan {
  std::filesystem::path mesh;               ///< the high mesh
  std::filesystem::path folder;             ///< the asset's, in the output folder
  std::map<Stage, StageSettings> settings;  ///< a stage on request runs where it is in here
  std::vector<std::string> budgets;         ///< as kiln-report takes them: "simplify.hausdorff<=0.012"
  std::string place;                        ///< in the scene; empty: it stands alone
  std::vector<PlanNeighbour> neighbours;    ///< in that scene
};

/// The runs of the stages, in order.
std::vector<StageRun> stage_runs(const AssetPlan& plan);

}  // namespace kiln
