// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/commands.h"

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdexcept>
#include <unistd.h>

#include "base/errors.h"
#include "base/file_names.h"
#include "base/interruption.h"
#include "base/json.h"
#include "base/process.h"
#include "kiln/build.h"
#include "kiln/clean.h"
#include "kiln/init.h"
#include "kiln/made_meshes.h"
#include "kiln/makefile.h"
#include "kiln/pipeline.h"
#include "kiln/plan/plan.h"
#include "kiln/plan/plan_file.h"
#include "kiln/presets.h"
#include "kiln/report_command.h"
#include "kiln/schema.h"
#include "kiln/step.h"
#include "kiln/sweep/sweep.h"
#include "runtime/scene_file/scene_file.h"

namespace kiln {

namespace fs = std::filesystem;

struct Commands::Values {
  int status = 0;
  std::vector<std::string> words;  ///< a pipeline file and assets
  BuildSettings build;
  ReportCommand report;
  PlanSettings plan_settings;
  fs::path build_plan;
  SweepSettings sweep;
  std::vector<fs::path> meshes;
  fs::path file = "pipeline.yaml";
  fs::path plan, archive, mesh;
  std::string member;
  std::string schema_of = "pipeline";
  double half_size = 0;
  int threads = 0;
};

namespace {

/// Prints what each preset is for, promises and sets.
void list_presets(bool as_json) {
  Json presets = Json::array();
  for (const Preset& preset : all_presets()) {
    Json settings = Json::object();
    std::string text;
    for (const auto& [name, value] : preset.settings) {
      settings[name] = value;
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, value);
    }
    presets.push_back(
        {{"name", preset.name}, {"purpose", preset.purpose}, {"error", preset.error}, {"settings", settings}});
    if (!as_json)
      std::printf("%s\tE of %g %% or less, %s: %s\n", std::string(preset.name).c_str(), 100 * preset.error,
                  std::string(preset.purpose).c_str(), text.c_str());
  }
  if (as_json) std::printf("%s\n", json_text({{"presets", presets}}).c_str());
}

/// Tells whether a word names a pipeline file, and not an asset.
bool names_pipeline(const std::string& word) { return word.ends_with(".yaml") || word.ends_with(".yml"); }

/// Takes the pipeline file off the front of `words`; the rest are assets.
Pipeline take_pipeline(std::vector<std::string>& words) {
  std::string file = "pipeline.yaml";
  if (!words.empty() && names_pipeline(words.front())) {
    file = words.front();
    words.erase(words.begin());
  }
  std::error_code error;
  if (!fs::exists(file, error) && file == "pipeline.yaml")
    throw BadInput(file, "does not exist", "a pipeline in this folder, or its file by name",
                   "write one with 'kiln init MESH...'");
  return load_pipeline(file);
}

/// Describes where an asset's mesh comes from.
std::string mesh_text(const Asset& asset) {
  if (!asset.square.empty()) return "a square of half-size " + asset.square;
  return asset.archive.empty() ? asset.mesh.string() : asset.archive.string() + ":" + asset.member;
}

void list(const Pipeline& pipeline, bool as_json) {
  if (as_json) {
    Json assets = Json::array();
    for (const Asset& asset : pipeline.assets) {
      Json stages = Json::array();
      for (const std::string& stage : stage_names())
        if (stage_info(stage).is_passed(asset.settings)) stages.push_back(stage);
      assets.push_back({{"name", asset.name},
                        {"default", !asset.on_request},
                        {"mesh", text_of_path(mesh_text(asset))},
                        {"stages", stages}});
    }
    std::printf("%s\n", json_text({{"assets", assets}}).c_str());
    return;
  }
  for (const Asset& asset : pipeline.assets)
    std::printf("%s\t%s\t%s\n", asset.name.c_str(), asset.on_request ? "on request" : "default",
                mesh_text(asset).c_str());
}

/// Builds, by a plan if one is given. Faults found before a stage runs are in the JSON object as well.
int run_build(std::vector<std::string>& words, const fs::path& plan, const BuildSettings& settings) {
  try {
    if (!plan.empty() && (words.empty() || !names_pipeline(words.front())))
      words.insert(words.begin(), pipeline_of_plan(plan).string());
    Pipeline pipeline = take_pipeline(words);
    if (!plan.empty()) apply_plan(pipeline, plan);
    return build(pipeline, select_assets(pipeline, words), settings);
  } catch (const std::runtime_error& error) {
    const auto tell = [&](ExitCode code) {
      if (settings.json)
        std::printf("%s\n", json_text({{"status", static_cast<int>(code)}, {"error", error.what()}}).c_str());
    };
    if (dynamic_cast<const BadInput*>(&error) != nullptr)
      tell(ExitCode::bad_input);
    else if (dynamic_cast<const WrongUsage*>(&error) != nullptr)
      tell(ExitCode::wrong_usage);
    else if (dynamic_cast<const MachineLacks*>(&error) != nullptr)
      tell(ExitCode::machine_lacks);
    else if (dynamic_cast<const Interrupted*>(&error) == nullptr)
      tell(ExitCode::failed);
    throw;
  }
}

void add_words(CLI::App& command, std::vector<std::string>& words, const std::string& assets) {
  command
      .add_option("pipeline.yaml asset", words,
                  "The pipeline (default pipeline.yaml), then assets (default " + assets + ")")
      ->option_text("[pipeline.yaml] [asset...]");
}

/// Becomes a program of the same folder as this one, which ends as it does when it is called by its own name.
[[noreturn]] void become_sibling(const std::string& name, const std::vector<std::string>& words) {
  std::vector<std::string> arguments = {(program_folder() / name).string()};
  arguments.insert(arguments.end(), words.begin(), words.end());
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  execv(pointers.front(), pointers.data());
  throw MachineLacks(arguments.front() + " cannot be started (" + std::strerror(errno) + "); install Kiln again");
}

}  // namespace

Commands::Commands(CLI::App& app) : values_(std::make_unique<Values>()) {
  Values& v = *values_;
  CLI::App& build = *app.add_subcommand("build", "Bring assets up to date");
  add_words(build, v.words, "all that are not on request");
  build.add_option("-j,--jobs", v.build.jobs, "Stages at a time, 0 for one per core (default 0; 0 to 1024)")
      ->check(CLI::Range(0, 1024));
  build.add_flag("-k,--keep-going", v.build.keep_going, "Build the other assets where one fails");
  build.add_flag("-n,--dry-run", v.build.dry_run, "Print what would run, run and write nothing");
  build.add_flag("--force", v.build.force, "Run all stages, also those that are up to date");
  build.add_option("--until", v.build.until, fmt::format("The last stage to run: {}", fmt::join(stage_names(), ", ")))
      ->type_name("STAGE");
  build
      .add_option("--plan", v.build_plan,
                  "Build by a plan of `kiln plan`; without a pipeline, the one that the plan names")
      ->type_name("FILE");
  build.add_flag("--json", v.build.json, "Print what became of every asset as one JSON object on stdout");
  build.add_flag("--quiet", v.build.quiet, "Print errors only");
  build.callback([&v] {
    if (!v.build.until.empty() && find_stage(v.build.until) == nullptr)
      throw WrongUsage(
          fmt::format("until: found '{}'; expected one of {}", v.build.until, fmt::join(stage_names(), ", ")));
    v.status = run_build(v.words, v.build_plan, v.build);
  });

  CLI::App& report = *app.add_subcommand("report", "Compare what was built with a baseline, for CI");
  add_words(report, v.words, "all that are not on request");
  report
      .add_option("--baseline", v.report.baseline,
                  "An earlier build: a metrics.json, its folder, or an output folder with one for each asset")
      ->type_name("PATH");
  report.add_flag("--same-run", v.report.same_run,
                  "The baseline was built on this machine just now: compare times and memory, too");
  report.add_flag("--always", v.report.always, "Write summary.md also where all is well");
  report.add_flag("--json", v.report.json, "Print the comparison as one JSON object on stdout");
  report.add_flag("--quiet", v.report.quiet, "Print what fails only");
  report.callback([&v] {
    const Pipeline pipeline = take_pipeline(v.words);
    v.status = report_on(pipeline, select_assets(pipeline, v.words), v.report);
  });

  CLI::App& plan_command =
      *app.add_subcommand("plan", "Choose the cheapest settings that keep an error, from small builds");
  add_words(plan_command, v.words, "all that are not on request");
  PlanSettings& plan_settings = v.plan_settings;
  auto* const error =
      plan_command
          .add_option("--error", plan_settings.error,
                      "The expected relighting error that assets may have, above 0 and below 1 (default: their budgets "
                      "for report.error.total)")
          ->check(CLI::Range(1e-6, 1.0));
  plan_command
      .add_option("--levels", plan_settings.levels, "The same, in levels of 8-bit sRGB in a mid-grey (0.01 to 50)")
      ->check(CLI::Range(0.01, 50.0))
      ->excludes(error);
  plan_command.add_option("--bytes", plan_settings.bytes, "Bytes that an asset may ship (default any)")
      ->check(CLI::PositiveNumber);
  plan_command
      .add_option("--seconds", plan_settings.seconds, "CPU seconds that an asset's build may take (default any)")
      ->check(CLI::PositiveNumber);
  auto* const lights =
      plan_command
          .add_option("--lights", plan_settings.color.lights,
                      "Lamps that assets are seen in, between commas, as kiln-spectrum takes them, for which the plan "
                      "says whether red, green and blue are enough (default D65)")
          ->type_name("NAMES");
  plan_command
      .add_option("--max-ciede2000", plan_settings.color.max_ciede2000,
                  "Difference of colours that they may cost at worst (default 1; 0.01 to 100)")
      ->check(CLI::Range(0.01, 100.0));
  plan_command
      .add_option("--least", plan_settings.least,
                  "The cost that is made least: seconds, bytes, or both, their product (default both)")
      ->check(CLI::IsMember({"both", "seconds", "bytes"}));
  plan_command
      .add_option("--keep", plan_settings.keep, "A setting that stays as the pipeline has it; any number of --keep")
      ->expected(1)
      ->take_all()
      ->type_name("STAGE.SETTING");
  plan_command.add_option("-o,--output", plan_settings.output, "The plan (default plan.yaml)")->type_name("FILE");
  plan_command
      .add_option("-j,--jobs", plan_settings.jobs, "Stages at a time, 0 for one per core (default 0; 0 to 1024)")
      ->check(CLI::Range(0, 1024));
  plan_command.add_flag("--json", plan_settings.json, "Print the plan as one JSON object on stdout");
  plan_command.add_flag("--quiet", plan_settings.quiet, "Print errors only");
  plan_command.callback([&v, lights] {
    v.plan_settings.names_lights = lights->count() > 0;
    const Pipeline pipeline = take_pipeline(v.words);
    v.status = plan(pipeline, select_assets(pipeline, v.words), v.plan_settings);
  });

  CLI::App& sweep_command = *app.add_subcommand("sweep", "Measure cost and error over combinations of settings");
  add_words(sweep_command, v.words, "all that are not on request");
  sweep_command
      .add_option("--set", v.sweep.axes,
                  "A setting and its values, as in bake.directions=256,1024; any number of --set")
      ->expected(1)
      ->take_all()
      ->type_name("STAGE.SETTING=VALUE,...");
  sweep_command.add_flag("--historic", v.sweep.historic,
                         "Measure the settings of Chapter's thesis and of US patent 7,948,490, too");
  sweep_command
      .add_option("--until", v.sweep.until,
                  fmt::format("The last stage of every point: {}", fmt::join(stage_names(), ", ")))
      ->type_name("STAGE");
  sweep_command
      .add_option("-o,--output", v.sweep.output,
                  "Folder of the results (default sweep/ in the pipeline's output folder)")
      ->type_name("FOLDER");
  sweep_command
      .add_option("-j,--jobs", v.sweep.jobs, "Stages at a time; more than 1 spoils the times (default 1; 1 to 1024)")
      ->check(CLI::Range(1, 1024));
  sweep_command.add_flag("--json", v.sweep.json, "Print all results as one JSON object on stdout");
  sweep_command.add_flag("--quiet", v.sweep.quiet, "Print errors only");
  sweep_command.callback([&v] {
    const Pipeline pipeline = take_pipeline(v.words);
    v.status = sweep(pipeline, select_assets(pipeline, v.words), v.sweep);
  });

  CLI::App& list_command = *app.add_subcommand("list", "Print the assets of a pipeline");
  add_words(list_command, v.words, "all");
  list_command.add_flag("--json", v.build.json, "Print them as one JSON object");
  list_command.callback([&v] { list(take_pipeline(v.words), v.build.json); });

  CLI::App& presets_command = *app.add_subcommand("presets", "Print the presets, what they promise and set");
  presets_command.add_flag("--json", v.build.json, "Print them as one JSON object");
  presets_command.callback([&v] { list_presets(v.build.json); });

  CLI::App& clean_command = *app.add_subcommand("clean", "Remove what was built");
  add_words(clean_command, v.words, "all that was built");
  clean_command.add_flag("--quiet", v.build.quiet, "Print errors and files that were kept only");
  clean_command.callback([&v] {
    const Pipeline pipeline = take_pipeline(v.words);
    clean(pipeline, v.words, v.build.quiet);
  });

  CLI::App& init_command = *app.add_subcommand("init", "Write a pipeline file of meshes");
  init_command.add_option("MESH", v.meshes, "Mesh files: OBJ, PLY, STL, OFF, glTF, GLB, FBX or DRC")->required();
  init_command.add_option("-o,--output", v.file, "The file to write, which must not be there (default pipeline.yaml)")
      ->type_name("FILE");
  init_command.callback([&v] {
    init_pipeline(v.meshes, v.file);
    std::fprintf(stderr, "kiln: wrote %s; 'kiln build%s' makes what it says\n", v.file.c_str(),
                 v.file == "pipeline.yaml" ? "" : (" " + shell_quoted(v.file.string())).c_str());
  });

  // These are programs of their own because they link readers of pictures and meshes, and every step of a build starts
  // this one.
  const auto add_sibling = [&](const std::string& name, const std::string& purpose) {
    CLI::App& command = *app.add_subcommand(name, fmt::format("{} (kiln-{})", purpose, name));
    command.set_help_flag();
    command.prefix_command();
    command.callback([&command, name] { become_sibling("kiln-" + name, command.remaining()); });
  };
  add_sibling("check", "Hold assets' folders against the format");
  add_sibling("export", "Write an asset as a glTF file");
  add_sibling("spectrum", "Say whether RGB is enough for lights and surfaces");
  add_sibling("serve", "Show a folder of assets in a browser");
  add_sibling("web-export", "Write a folder of assets as a web site");

  // `kiln schema` makes docs/schema/pipeline.schema.json, and `kiln schema scene` that of scene.yaml.
  CLI::App& schema =
      *app.add_subcommand("schema", "Print the JSON Schema of pipeline.yaml, or of scene.yaml")->group("");
  schema.add_option("file", v.schema_of)->check(CLI::IsMember({"pipeline", "scene"}));
  schema.callback(
      [&v] { std::printf("%s\n", json_text(v.schema_of == "scene" ? scene_schema() : pipeline_schema(), 2).c_str()); });

  // `kiln step` is for the Makefile to call.
  CLI::App& step = *app.add_subcommand("step", "Run one stage")->group("");
  step.add_option("--threads", v.threads);
  step.add_option("plan", v.plan)->required();
  step.callback([&v] { v.status = run_step(v.plan, program_folder(), v.threads); });
  CLI::App& extract = *app.add_subcommand("extract", "Take a mesh out of an archive")->group("");
  extract.add_option("archive", v.archive)->required();
  extract.add_option("member", v.member)->required();
  extract.add_option("-o,--output", v.mesh)->required();
  extract.callback([&v] { extract_member(v.archive, v.member, v.mesh); });
  CLI::App& square = *app.add_subcommand("square", "Make a square mesh")->group("");
  square.add_option("half_size", v.half_size)->required();
  square.add_option("-o,--output", v.mesh)->required();
  square.callback([&v] { write_square(v.half_size, v.mesh); });
}

Commands::~Commands() = default;

int Commands::status() const { return values_->status; }

}  // namespace kiln
