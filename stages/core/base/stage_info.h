// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/options.h"

namespace kiln {

/// What pipeline.yaml says of one stage: the text of each setting by its name, the defaults left out.
using StageSettings = std::map<std::string, std::string>;

/// Settings of an asset's stages, by stage name. A stage on request has an entry only where the asset passes it.
using AssetSettings = std::map<std::string, StageSettings>;

/// Tells whether an asset's vertices are baked, in place of texels.
bool bakes_vertices(const AssetSettings& settings);

/// The settings of a stage as its program knows them, with their defaults, and what pipeline.yaml may say besides.
class StageOptions {
 public:
  /// Binds the table of a settings struct to one of its own, and adds `seed`, which all programs take.
  template <class Settings>
  static StageOptions of(OptionSet (*options_of)(Settings&)) {
    struct Bound {
      Settings settings;
      int seed = 1;
    };
    auto bound = std::make_shared<Bound>();
    OptionSet options = options_of(bound->settings);
    add_seed(options, bound->seed);
    return {std::move(options), std::move(bound)};
  }

  const std::vector<Option>& all() const { return options_.options(); }
  const Option* find(const std::string& name) const { return options_.find(name); }

 private:
  StageOptions(OptionSet options, std::shared_ptr<void> bound)
      : bound_(std::move(bound)), options_(std::move(options)) {}
  static void add_seed(OptionSet& options, int& seed);

  std::shared_ptr<void> bound_;  // what options_ is bound to
  OptionSet options_;
};

/// A settings struct filled with what pipeline.yaml says. Throws WrongUsage as the options do.
template <class Settings>
Settings settings_from(const StageSettings& given, OptionSet (*options_of)(Settings&)) {
  Settings settings;
  const OptionSet options = options_of(settings);
  for (const auto& [name, text] : given)
    if (const Option* option = options.find(name)) option->set(text);
  return settings;
}

/// One stage of one asset as make runs it. Paths are as the command has them.
struct StageRun {
  std::string name;                                 ///< of the stage
  std::vector<std::string> command;                 ///< program (a bare name, found beside kiln) and arguments
  std::vector<std::string> helpers = {};            ///< further programs it runs
  std::vector<std::filesystem::path> inputs = {};   ///< files of the user, and of other stages of the asset
  std::vector<std::filesystem::path> outputs = {};  ///< the record, `<stage>.json`, first
  std::filesystem::path checkpoint = {};            ///< a folder; where it is there, the stage goes on with --resume
  std::vector<std::string> limits = {};             ///< more arguments, budgets of a report: others alone judge it anew

  /// Adds words to the command.
  void add(std::initializer_list<std::string> words) { command.insert(command.end(), words); }

  /// Adds `--name value` for each of the settings that is given, in the order of `options`.
  void add_settings(const StageOptions& options, const StageSettings& given);

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
  std::filesystem::path mesh;             ///< the high mesh
  std::filesystem::path folder;           ///< the asset's, in the output folder
  AssetSettings settings;                 ///< a stage on request runs where it is in here
  std::vector<std::string> budgets;       ///< as kiln-report takes them: "simplify.hausdorff<=0.012"
  std::string place;                      ///< in the scene; empty: it stands alone
  std::vector<PlanNeighbour> neighbours;  ///< in that scene

  /// The settings of a stage; empty where nothing is said of it.
  const StageSettings& settings_of(const std::string& stage) const;
  bool passes(const std::string& stage) const { return settings.contains(stage); }
};

/// Metrics that a stage writes together.
struct MetricGroup {
  std::string names;                                   ///< separated by blanks, as in the stage's record
  std::string prefix = {};                             ///< common beginning of those that are not always written
  std::string setting = {};                            ///< setting that they depend on, for messages: "bounces of bake"
  bool (*is_written)(const AssetSettings&) = nullptr;  ///< null: always
};

/// Description of a stage, beside its settings: all that the driver and other tools know of it.
struct StageInfo {
  std::string name;               ///< name in pipeline.yaml; the program's is kiln- and this
  bool on_request = false;        ///< an asset passes it only where pipeline.yaml has a block for it
  bool for_texels = false;        ///< an asset whose vertices are baked does not pass it
  std::string list_setting = {};  ///< setting that a list in place of the block stands for; empty: it may be none
  StageOptions (*options)() = nullptr;
  std::vector<std::pair<std::string, std::string>> rivals = {};  ///< settings that exclude each other
  std::vector<MetricGroup> metrics = {};                         ///< besides those of every stage
  StageRun (*run)(const AssetPlan&) = nullptr;                   ///< its command, inputs and outputs

  /// Tells whether an asset of these settings passes it.
  bool is_passed(const AssetSettings& settings) const;

  /// The settings that may not stand beside `setting`.
  std::vector<std::string> rivals_of(const std::string& setting) const;
};

/// A path as a word of a command that does not look like an option.
std::string command_word(const std::filesystem::path& path);

/// A path as the name of a folder: with a slash behind it.
std::string folder_word(const std::filesystem::path& path);

}  // namespace kiln
