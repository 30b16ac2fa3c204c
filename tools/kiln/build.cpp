#include "kiln/build.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <set>
#include <thread>
#include <unistd.h>

#include "base/errors.h"
#include "base/outputs.h"
#include "base/process.h"
#include "base/progress.h"
#include "import/import_settings.h"
#include "kiln/step.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

/// A folder that is gone when it goes out of scope.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (fs::temp_directory_path() / "kiln-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr)
      throw BadInput(pattern, "cannot be made", "a folder for temporary files",
                     "set TMPDIR to one that can be written");
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// A descriptor of our stderr that make's children find, while make's own messages go to us.
class MessageDescriptor {
 public:
  MessageDescriptor() : descriptor_(fcntl(STDERR_FILENO, F_DUPFD, 100)) {}
  ~MessageDescriptor() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  MessageDescriptor(const MessageDescriptor&) = delete;
  MessageDescriptor& operator=(const MessageDescriptor&) = delete;

  std::string number() const { return descriptor_ < 0 ? "" : std::to_string(descriptor_); }

 private:
  int descriptor_;
};

fs::path high_mesh_of(const Pipeline& pipeline, const Asset& asset) {
  const fs::path made = pipeline.output / asset.name / "high";
  if (!asset.square.empty()) return made / "square.obj";
  return asset.archive.empty() ? asset.mesh : made / fs::path(asset.member).filename();
}

/// An asset as kiln-bake's --neighbour has it.
std::string neighbour_text(const fs::path& mesh, const std::string& place, const Asset& asset) {
  std::string text = fmt::format("{};place={}", mesh.string(), place);
  const auto add = [&](Stage stage, const char* name) {
    const auto settings = asset.settings.find(stage);
    if (settings == asset.settings.end()) return;
    const auto found = settings->second.find(name);
    if (found == settings->second.end()) return;
    std::string value = found->second;
    for (std::size_t k; (k = value.find("; ")) != std::string::npos;) value.replace(k, 2, ",");  // of a list
    text += fmt::format(";{}={}", name, value);
  };
  for (const char* name : {"albedo", "albedo-texture", "albedo-encoding"}) add(Stage::normals, name);
  ImportSettings import;
  OptionSet import_options;
  add_import_options(import_options, import);
  for (const Option& option : import_options.options()) add(Stage::simplify, option.name.c_str());
  return text;
}

/// The assets that stand in the same scene as `asset`.
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

/// What the record of an earlier run says of the files it read: their hashes by name.
std::map<std::string, std::string> recorded_hashes(const Pipeline& pipeline, const StageRun& run) {
  std::error_code error;
  const fs::path record = pipeline.folder / run.outputs.front();
  if (record.extension() != ".json" || !fs::is_regular_file(record, error)) return {};
  const Json json = Json::parse(read_text(record), nullptr, false);
  if (!json.is_object() || !json.contains("inputs") || !json["inputs"].is_object()) return {};
  std::map<std::string, std::string> hashes;
  for (const auto& [file, hash] : json["inputs"].items())
    if (hash.is_string()) hashes[file] = hash.get<std::string>();
  return hashes;
}

/// Arguments that have make take those files for new that no stage makes and that are not what the records say: one
/// that was replaced by an older file is another input, which times do not tell.
std::vector<std::string> changed_sources(const Pipeline& pipeline, const std::vector<MakeRule>& rules) {
  std::set<fs::path> made;
  for (const MakeRule& rule : rules) made.insert(rule.run.outputs.begin(), rule.run.outputs.end());
  std::map<fs::path, std::string> hash_of;
  std::set<fs::path> changed;
  std::error_code error;
  for (const MakeRule& rule : rules) {
    const std::map<std::string, std::string> recorded = recorded_hashes(pipeline, rule.run);
    for (const fs::path& input : rule.run.inputs) {
      const auto found = recorded.find(input.string());
      if (made.contains(input) || found == recorded.end() || !fs::is_regular_file(pipeline.folder / input, error))
        continue;
      std::string& hash = hash_of[input];
      if (hash.empty()) hash = hash_file(pipeline.folder / input);
      if (hash != found->second) changed.insert(input);
    }
  }
  std::vector<std::string> arguments;
  for (const fs::path& file : changed) arguments.insert(arguments.end(), {"--what-if", file.string()});
  return arguments;
}

/// Files that an earlier run of a stage read besides those that its command names, such as textures of a material: its
/// record has them.
std::vector<fs::path> recorded_inputs(const Pipeline& pipeline, const StageRun& run) {
  std::error_code error;
  std::vector<fs::path> files;
  for (const auto& [file, hash] : recorded_hashes(pipeline, run))
    if (std::find(run.inputs.begin(), run.inputs.end(), fs::path(file)) == run.inputs.end() &&
        fs::is_regular_file(pipeline.folder / file, error))
      files.emplace_back(file);
  return files;
}

bool holds(const fs::path& file, const std::string& text) {
  std::error_code error;
  return fs::is_regular_file(file, error) && read_text(file) == text;
}

/// Leaves a file that holds the text already as it is, with its time.
void write_if_changed(const fs::path& file, const std::string& text) {
  if (holds(file, text)) return;
  OutputSet outputs(folder_of(file));
  outputs.add_text(file.filename().string(), text);
  outputs.commit();
}

/// The stage that cannot start because the file it needs is not there; says so.
bool lacks_mesh(const Pipeline& pipeline, const Asset& asset) {
  if (!asset.square.empty()) return false;
  const fs::path source = asset.archive.empty() ? asset.mesh : asset.archive;
  std::error_code error;
  if (fs::is_regular_file(pipeline.folder / source, error)) return false;
  const BadInput lack(fmt::format("{}:{}", pipeline.file.string(), asset.line),
                      fmt::format("the {} of '{}', {}, does not exist", asset.archive.empty() ? "mesh" : "archive",
                                  asset.name, source.string()),
                      "a file", "check the path, or install the package it comes from (tools/setup)");
  std::fprintf(stderr, "kiln: %s\nkiln: asset '%s', stage '%s' failed (exit status 3)\n", lack.what(),
               asset.name.c_str(), asset.archive.empty() ? "simplify" : "extract");
  return true;
}

struct MakeEnd {
  ProcessEnd end;
  std::vector<std::string> output, errors;  // make's own lines
};

MakeEnd run_make(const Pipeline& pipeline, const fs::path& makefile, const std::vector<std::string>& arguments,
                 std::vector<std::pair<std::string, std::string>> environment) {
  MakeEnd result;
  ProcessSettings settings;
  settings.folder = pipeline.folder;
  // A make that runs the driver must not lend its flags and job slots to ours.
  environment.insert(environment.end(),
                     {{"MAKEFLAGS", ""}, {"MFLAGS", ""}, {"MAKELEVEL", ""}, {"GNUMAKEFLAGS", ""}, {"MAKEFILES", ""}});
  settings.environment = std::move(environment);
  settings.on_output_line = [&](const std::string& line) { result.output.push_back(line); };
  settings.on_error_line = [&](const std::string& line) { result.errors.push_back(line); };
  std::vector<std::string> command = {"make", "--silent", "--no-print-directory", "-f", makefile.string()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  result.end = run_process(command, settings);
  return result;
}

[[noreturn]] void fail_as_make(const MakeEnd& make) {
  std::string text;
  for (const std::string& line : make.errors) text += (text.empty() ? "" : "\n") + line;
  throw std::runtime_error(text.empty() ? "make ended without a word" : text);
}

std::vector<std::string> names_of(const std::vector<const Asset*>& assets) {
  std::vector<std::string> names;
  for (const Asset* asset : assets) names.push_back(asset->name);
  return names;
}

/// Prints what make would run, one line each: the asset, the stage, the command.
int say_what_would_run(const Pipeline& pipeline, const std::vector<const Asset*>& assets, std::vector<MakeRule> rules) {
  const fs::path programs = program_folder();
  const TemporaryFolder temporary;
  // Where it runs nothing, make takes an output that is older than its record, as all are, for new. So the rules here
  // depend on the records alone, but for an output that somebody changed by hand.
  std::map<fs::path, fs::path> record_of;
  for (const MakeRule& rule : rules)
    for (const fs::path& output : rule.run.outputs)
      if (output != rule.run.outputs.front()) record_of[output] = rule.run.outputs.front();
  const auto time_of = [&](const fs::path& file) {
    std::error_code missing;  // and then the earliest time there is
    return fs::last_write_time(pipeline.folder / file, missing);
  };
  const auto as_its_stage_left_it = [&](const fs::path& file) {
    const auto found = record_of.find(file);
    return found != record_of.end() && time_of(file) <= time_of(found->second);
  };
  int count = 0;
  // make itself decides, on stamps as they would be: those that would change are new files elsewhere.
  for (MakeRule& rule : rules) {
    std::erase_if(rule.run.inputs, as_its_stage_left_it);
    const std::string text = stamp_text(rule.run, programs);
    if (holds(pipeline.folder / rule.stamp, text)) continue;
    rule.stamp = temporary.path() / fmt::format("{}.command", ++count);
    write_if_changed(rule.stamp, text);
  }
  const fs::path makefile = temporary.path() / "Makefile";
  write_if_changed(makefile, makefile_text(rules, programs));
  std::vector<std::string> arguments = {"--dry-run", "STEP=", "PROGRAMS=."};
  const std::vector<std::string> changed = changed_sources(pipeline, rules);
  arguments.insert(arguments.end(), changed.begin(), changed.end());
  for (const std::string& name : names_of(assets)) arguments.push_back(name);
  const MakeEnd make = run_make(pipeline, makefile, arguments, {});
  if (!make.end.succeeded()) fail_as_make(make);
  for (std::string line : make.output) {
    // " ASSET STAGE -- ./PROGRAM ARGUMENTS"
    const std::size_t name = line.find_first_not_of(' '), stage = line.find(' ', name) + 1,
                      command = line.find(" -- ./", stage);
    std::printf("[%s] %s: %s\n", line.substr(name, stage - 1 - name).c_str(),
                line.substr(stage, command - stage).c_str(), line.substr(command + 6).c_str());
  }
  if (make.output.empty()) std::printf("nothing to do\n");
  return 0;
}

/// Says where the report is and whether it met the budgets.
int judge(const Pipeline& pipeline, const Asset& asset, bool quiet) {
  const fs::path folder = (pipeline.folder / pipeline.output / asset.name).lexically_normal();
  const Json metrics = Json::parse(read_text(folder / "metrics.json"));
  int missed = 0, count = 0;
  for (const Json& budget : metrics.at("report").at("budgets")) {
    ++count;
    if (budget.at("met").get<bool>()) continue;
    ++missed;
    std::fprintf(stderr, "kiln: asset '%s' misses a budget: %s is %s, expected %s %s\n", asset.name.c_str(),
                 budget.at("metric").get<std::string>().c_str(), budget.at("value").dump().c_str(),
                 budget.at("relation").get<std::string>().c_str(), budget.at("limit").dump().c_str());
  }
  const std::string verdict = count == 0    ? "no budgets"
                              : missed == 0 ? fmt::format("{} of {} budgets met", count, count)
                                            : fmt::format("{} of {} budgets missed", missed, count);
  if (!quiet)
    std::fprintf(stderr, "[%s] report: %s (%s)\n", asset.name.c_str(), (folder / "report.html").c_str(),
                 verdict.c_str());
  return static_cast<int>(missed > 0 ? ExitCode::budget_missed : ExitCode::done);
}

}  // namespace

std::vector<MakeRule> make_rules(const Pipeline& pipeline) {
  std::vector<MakeRule> rules;
  for (const Asset& asset : pipeline.assets) {
    AssetPlan plan;
    plan.folder = pipeline.output / asset.name;
    plan.mesh = high_mesh_of(pipeline, asset);
    plan.settings = asset.settings;
    plan.budgets = asset.budgets;
    if (const auto place = pipeline.places.find(asset.name); place != pipeline.places.end()) plan.place = place->second;
    plan.neighbours = neighbours_of(pipeline, asset);
    std::vector<StageRun> runs;
    if (!asset.square.empty())
      runs.push_back({"square", {"kiln", "square", asset.square, "-o", plan.mesh.string()}, {}, {}, {plan.mesh}});
    if (!asset.archive.empty())
      runs.push_back({"extract",
                      {"kiln", "extract", asset.archive.string(), asset.member, "-o", plan.mesh.string()},
                      {},
                      {asset.archive},
                      {plan.mesh}});
    for (StageRun& run : stage_runs(plan)) {
      if (run.name == stage_name(Stage::normals) || run.name == stage_name(Stage::bake))
        for (const fs::path& file : recorded_inputs(pipeline, run)) run.inputs.push_back(file);
      runs.push_back(std::move(run));
    }
    for (StageRun& run : runs) {
      const fs::path stamp = pipeline.output / ".kiln" / asset.name / (run.name + ".command");
      rules.push_back({asset.name, std::move(run), stamp});
    }
  }
  return rules;
}

std::string stamp_text(const StageRun& run, const fs::path& programs) {
  std::string text;
  for (const std::string& word : run.command) text += (text.empty() ? "" : " ") + shell_quoted(word);
  text += fmt::format("\nversion {}\n", KILN_VERSION);
  std::vector<std::string> names = {run.command.front()};
  names.insert(names.end(), run.helpers.begin(), run.helpers.end());
  for (const std::string& name : names) {
    if (name == "kiln") continue;  // extracts; what it does to assets is in the commands
    if (!fs::exists(programs / name))
      throw MachineLacks(fmt::format("{} is not beside kiln in {}; build it: make build", name, programs.string()));
    text += fmt::format("{} {}\n", name, hash_file(programs / name));
  }
  return text;
}

int gravest_status(const std::vector<int>& statuses) {
  constexpr int by_gravity[] = {5, 3, 2, 4, 0};
  int gravest = 0;
  const auto rank = [&](int status) {
    return std::find(std::begin(by_gravity), std::end(by_gravity), status) - std::begin(by_gravity);
  };
  for (const int status : statuses)
    // Whatever is not in the list is a defect, graver than all of it.
    if (rank(status) == std::ssize(by_gravity))
      return static_cast<int>(ExitCode::failed);
    else if (rank(status) < rank(gravest))
      gravest = status;
  return gravest;
}

int build(const Pipeline& pipeline, const std::vector<const Asset*>& assets, const BuildSettings& settings) {
  // What can be known to fail beforehand.
  std::vector<int> statuses;
  std::vector<const Asset*> buildable;
  for (const Asset* asset : assets) {
    if (!lacks_mesh(pipeline, *asset)) {
      buildable.push_back(asset);
      continue;
    }
    statuses.push_back(static_cast<int>(ExitCode::bad_input));
    if (!settings.keep_going) return statuses.back();
  }
  if (buildable.empty()) return gravest_status(statuses);

  std::vector<MakeRule> rules = make_rules(pipeline);
  if (settings.dry_run) return say_what_would_run(pipeline, buildable, std::move(rules));

  // The Makefile and the stamps it depends on.
  const fs::path programs = program_folder();
  std::map<std::string, std::string> stamps;
  for (const MakeRule& rule : rules) write_if_changed(pipeline.folder / rule.stamp, stamp_text(rule.run, programs));
  const fs::path makefile = pipeline.output / "Makefile";
  write_if_changed(pipeline.folder / makefile, makefile_text(rules, programs));

  // Assets side by side share the cores: within one, each stage waits for the one before.
  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const int jobs = settings.jobs > 0 ? settings.jobs : cores;
  const int side_by_side = std::min(jobs, static_cast<int>(buildable.size()));
  const TemporaryFolder temporary;
  const fs::path events_file = temporary.path() / "events";
  const MessageDescriptor messages;
  std::vector<std::string> arguments = {fmt::format("-j{}", jobs),
                                        fmt::format("THREADS={}", std::max(1, cores / side_by_side))};
  if (settings.keep_going) arguments.push_back("--keep-going");
  const std::vector<std::string> changed = changed_sources(pipeline, rules);
  arguments.insert(arguments.end(), changed.begin(), changed.end());
  for (const std::string& name : names_of(buildable)) arguments.push_back(name);
  const MakeEnd make = run_make(pipeline, makefile, arguments,
                                {{step_environment::events, events_file.string()},
                                 {step_environment::messages, messages.number()},
                                 {step_environment::alone, side_by_side == 1 ? "1" : ""}});
  throw_if_interrupted();

  // What became of it.
  const std::vector<StepEvent> events = read_events(events_file);
  std::set<std::string> failed;
  for (const StepEvent& event : events)
    if (event.status != 0 && event.status != static_cast<int>(ExitCode::budget_missed)) {
      failed.insert(event.asset);
      statuses.push_back(event.status);
    }
  if (!make.end.succeeded() && failed.empty()) fail_as_make(make);
  if (events.empty() && !settings.quiet) std::fprintf(stderr, "kiln: nothing to do, all is up to date\n");
  const bool stopped = !failed.empty() && !settings.keep_going;
  for (const Asset* asset : buildable)
    if (!stopped && !failed.contains(asset->name)) statuses.push_back(judge(pipeline, *asset, settings.quiet));
  return gravest_status(statuses);
}

}  // namespace kiln
