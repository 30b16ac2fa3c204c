// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/stages.h"

#include <cctype>
#include <fmt/format.h>

#include "asset/format.h"
#include "atlas/atlas_settings.h"
#include "bake/bake_settings.h"
#include "compress/compress_settings.h"
#include "normals/normals_settings.h"
#include "report/report_settings.h"
#include "simplify/simplify_settings.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

struct SeedSetting {
  int seed = 1;
};

template <class Settings>
struct Storage {
  Settings settings;
  SeedSetting seed;
};

template <class Settings>
OptionSet bind(std::shared_ptr<void>& storage, OptionSet (*options_of)(Settings&)) {
  auto bound = std::make_shared<Storage<Settings>>();
  OptionSet options = options_of(bound->settings);
  options.integer("seed", bound->seed.seed, 0, 2147483647, "Seed of everything random");
  storage = std::move(bound);
  return options;
}

OptionSet bind(Stage stage, std::shared_ptr<void>& storage) {
  switch (stage) {
    case Stage::simplify:
      return bind(storage, simplify_options);
    case Stage::atlas:
      return bind(storage, atlas_options);
    case Stage::normals:
      return bind(storage, normals_options);
    case Stage::bake:
      return bind(storage, bake_options);
    case Stage::compress:
      return bind(storage, compress_options);
    case Stage::report:
      return bind(storage, report_options);
  }
  return {};
}

const StageSettings& settings_of(const AssetPlan& plan, Stage stage) {
  static const StageSettings none;
  const auto found = plan.settings.find(stage);
  return found == plan.settings.end() ? none : found->second;
}

/// Appends `--name value` for what is given, in the order that --help has.
void append_settings(std::vector<std::string>& command, const AssetPlan& plan, Stage stage) {
  const StageOptions options(stage);
  const StageSettings& given = settings_of(plan, stage);
  for (const Option& option : options.all()) {
    const auto found = given.find(option.name);
    if (found == given.end() || (option.is_switch && found->second == "false")) continue;
    const std::string& value = found->second;
    const bool looks_like_option = value.size() > 1 && value[0] == '-' && std::isalpha(value[1]) != 0;
    command.push_back("--" + option.name + (looks_like_option ? "=" + value : ""));
    if (!option.is_switch && !looks_like_option) command.push_back(value);
  }
}

/// The bake of an asset by itself.
StageRun bake_run(const AssetPlan& plan, const std::string& mesh, const fs::path& atlas, const fs::path& normals) {
  const fs::path prt = plan.folder / "prt";
  const fs::path atlas_record = plan.folder / "atlas.json", normals_record = normals / "normals.json";
  StageRun bake{"bake",
                {"kiln-bake", atlas.string(), "--detail", normals.string() + "/"},
                {},
                {plan.mesh, atlas_record, atlas, normals_record},
                {prt / "bake.json"},
                {}};
  // A low receiver lies beneath the high mesh here and above it there: it is in the shadow of its own mesh, which is
  // what kiln-bake takes where nothing is said.
  if (effective_setting(plan.settings, Stage::bake, "receiver") == "high")
    bake.command.insert(bake.command.end(), {"--occluder", mesh});
  bake.command.insert(bake.command.end(), {"-o", prt.string() + "/"});
  if (!plan.place.empty()) bake.command.insert(bake.command.end(), {"--place", plan.place});
  for (const PlanNeighbour& neighbour : plan.neighbours) {
    bake.command.insert(bake.command.end(), {"--neighbour", neighbour.text});
    bake.inputs.push_back(neighbour.mesh);
  }
  append_settings(bake.command, plan, Stage::bake);
  const int bands = effective_setting(plan.settings, Stage::bake, "bands").get<int>();
  for (int i = 0; i < bands * bands; ++i) bake.outputs.push_back(prt / plane_file(0, i));
  for (const char* name : {atlas_mesh_name, normal_map_name, ranges_name}) bake.outputs.push_back(prt / name);
  // A bake that interpolates texels does not go by blocks of directions, and has no checkpoints.
  if (effective_setting(plan.settings, Stage::bake, "adaptive") == 0) bake.checkpoint = plan.folder / "prt.checkpoint";
  return bake;
}

}  // namespace

std::vector<std::string> StageRun::whole_command() const {
  std::vector<std::string> whole = command;
  whole.insert(whole.end(), limits.begin(), limits.end());
  return whole;
}

std::string stage_name(Stage stage) {
  switch (stage) {
    case Stage::simplify:
      return "simplify";
    case Stage::atlas:
      return "atlas";
    case Stage::normals:
      return "normals";
    case Stage::bake:
      return "bake";
    case Stage::compress:
      return "compress";
    case Stage::report:
      return "report";
  }
  return "";
}

bool is_on_request(Stage stage) { return stage == Stage::compress; }

StageOptions::StageOptions(Stage stage) : options_(bind(stage, storage_)) {}

std::string rival_of(Stage stage, const std::string& setting) {
  if (stage == Stage::simplify && setting == "faces") return "max-error";
  if (stage == Stage::simplify && setting == "max-error") return "faces";
  if (stage == Stage::normals || stage == Stage::bake) {
    if (setting == "albedo") return "albedo-texture";
    if (setting == "albedo-texture") return "albedo";
  }
  if (stage == Stage::atlas && setting == "size") return "texels-per-unit";
  if (stage == Stage::atlas && setting == "texels-per-unit") return "size";
  return "";
}

std::string command_word(const fs::path& path) { return (path.native().starts_with('-') ? "./" : "") + path.native(); }

bool names_a_file(const std::string& setting) { return setting == "albedo-texture"; }

Json effective_setting(const std::map<Stage, StageSettings>& settings, Stage stage, const std::string& setting) {
  const StageOptions options(stage);
  const Option& option = *options.find(setting);
  const auto block = settings.find(stage);
  if (block != settings.end())
    if (const auto found = block->second.find(setting); found != block->second.end()) option.set(found->second);
  return option.get();
}

std::vector<StageRun> stage_runs(const AssetPlan& plan) {
  const fs::path& folder = plan.folder;
  const fs::path normals = folder / "normals", prt = folder / "prt";
  const fs::path low = folder / "low.drc", atlas = folder / "atlas.drc", report = folder / "report.html";
  const fs::path simplify_record = folder / "simplify.json", atlas_record = folder / "atlas.json";
  const fs::path normals_record = normals / "normals.json", bake_record = prt / "bake.json";
  const std::string mesh = command_word(plan.mesh), normals_folder = normals.string() + "/",
                    prt_folder = prt.string() + "/";

  // A stage's outputs are renamed together, its record last. The record stands first here, and whoever reads an output
  // depends on it too.
  StageRun simplify{"simplify", {"kiln-simplify", mesh, "-o", low.string()}, {}, {plan.mesh}, {simplify_record, low},
                    {}};
  append_settings(simplify.command, plan, Stage::simplify);

  StageRun cut{"atlas",
               {"kiln-atlas", low.string(), "-o", atlas.string()},
               {},
               {simplify_record, low},
               {atlas_record, atlas, folder / "atlas.png"},
               {}};
  if (effective_setting(plan.settings, Stage::atlas, "density") == "transfer") {
    cut.command.insert(cut.command.end(), {"--high", mesh});
    cut.inputs.push_back(plan.mesh);
  }
  append_settings(cut.command, plan, Stage::atlas);

  StageRun match{"normals",
                 {"kiln-normals", mesh, atlas.string(), "-o", normals_folder},
                 {},
                 {plan.mesh, simplify_record, atlas_record, atlas},
                 {normals_record, normals / "normal.png", normals / "position.exr", normals / "coverage.png",
                  normals / "match.png"},
                 {}};
  append_settings(match.command, plan, Stage::normals);

  const StageRun bake = bake_run(plan, mesh, atlas, normals);

  StageRun tell{"report",
                {"kiln-report", folder.string(), "-o", report.string(), "--high", mesh},
                {"kiln-render"},
                {plan.mesh, simplify_record, atlas_record, normals_record, bake_record},
                {folder / "report.json", report, folder / "metrics.json", folder / "report.png"},
                {}};
  std::vector<StageRun> runs = {simplify, cut, match, bake};
  if (plan.settings.contains(Stage::compress)) {
    const fs::path small = folder / "small", compress_record = small / "compress.json";
    const std::string small_folder = small.string() + "/";
    // What else it writes is its own choice: planes, or weights with pca.json.
    StageRun compress{"compress",
                      {"kiln-compress", prt_folder, "-o", small_folder},
                      {},
                      {bake_record},
                      {compress_record, small / atlas_mesh_name, small / normal_map_name},
                      {}};
    append_settings(compress.command, plan, Stage::compress);
    runs.push_back(compress);
    tell.command.insert(tell.command.end(), {"--compressed", small_folder});
    tell.inputs.push_back(compress_record);
  }
  append_settings(tell.command, plan, Stage::report);
  for (const std::string& budget : plan.budgets) tell.limits.insert(tell.limits.end(), {"--budget", budget});
  runs.push_back(tell);
  return runs;
}

}  // namespace kiln
