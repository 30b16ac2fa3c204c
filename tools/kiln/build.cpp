// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/build.h"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <map>
#include <set>
#include <thread>

#include "base/asset_layout.h"
#include "base/errors.h"
#include "base/files.h"
#include "base/interruption.h"
#include "base/json.h"
#include "base/process.h"
#include "base/stopwatch.h"
#include "kiln/file_checks.h"
#include "kiln/index_page.h"
#include "kiln/make_process.h"
#include "kiln/output_lock.h"
#include "kiln/report_command.h"
#include "kiln/summary.h"
#include "kiln/text_file.h"
#include "report/judging.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr int missed_budget = static_cast<int>(ExitCode::budget_missed);

/// Reads the metrics of an asset; null if it has no report.
Json metrics_of_asset(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_regular_file(folder / report_metrics, error) || !fs::is_regular_file(folder / layout::report_page, error))
    return {};
  const Json metrics = Json::parse(read_text(folder / report_metrics), nullptr, false);
  return metrics.is_object() ? metrics : Json();
}

/// One build: the steps to run, the run, and its outcome.
class Build {
 public:
  Build(const Pipeline& pipeline, const BuildSettings& settings) : pipeline_(pipeline), settings_(settings) {}

  int run(const std::vector<const Asset*>& assets) {
    if (!check_files(assets)) return finish();
    if (settings_.dry_run) {
      plan();
      say_what_would_run();
      return finish();
    }
    const OutputLock lock(pipeline_.folder / pipeline_.output);
    plan();
    if (settings_.force) forget();
    save_plans();
    if (const bool any = std::any_of(wanted_.begin(), wanted_.end(), [&](std::size_t k) { return must_run(k); }); any)
      run_stages();
    else if (!settings_.quiet)
      std::fprintf(stderr, "kiln: nothing to do, all is up to date\n");
    judge_all();
    write_index(pipeline_);
    if (settings_.until.empty())
      write_gate_files(pipeline_, outcomes_);
    else
      remove_gate_files(pipeline_);  // they would tell of an earlier build
    return finish();
  }

 private:
  bool must_run(std::size_t rule) const { return !reasons_[rule].empty(); }

  /// Reports files that no stage could read; returns whether something can be built all the same.
  bool check_files(const std::vector<const Asset*>& assets) {
    std::set<std::string> said;
    for (const Asset* asset : assets) {
      AssetOutcome& outcome = outcomes_.emplace_back();
      outcome.name = asset->name;
      outcome.folder = (pipeline_.folder / pipeline_.output / asset->name).lexically_normal().string();
      for (const BadInput& fault : file_faults(pipeline_, *asset)) {
        if (said.insert(fault.what()).second) std::fprintf(stderr, "kiln: %s\n", fault.what());
        outcome.status = static_cast<int>(ExitCode::bad_input);
        outcome.error += (outcome.error.empty() ? "" : "; ") + std::string(fault.what());
      }
      if (outcome.status == 0) buildable_.push_back(asset);
    }
    return !buildable_.empty() && (settings_.keep_going || buildable_.size() == assets.size());
  }

  /// Decides which rules are wanted, which of them have to run, and why.
  void plan() {
    rules_ = make_rules(pipeline_);
    needs_ = needs_of(rules_);
    FileHashes programs(program_folder());
    FileHashes hashes(pipeline_.folder);
    reasons_.resize(rules_.size());
    plans_.resize(rules_.size());
    states_.resize(rules_.size());
    for (const Asset* asset : buildable_)
      for (const std::size_t rule : rules_until(asset->name)) want(rule);
    for (std::size_t k = 0; k < rules_.size(); ++k) {
      const MakeRule& rule = rules_[k];
      plans_[k] = {rule.asset, rule.run, stamp_text(rule.run, programs), rule.state};
    }
    // `wanted_` lists each rule after those that it needs.
    for (const std::size_t k : wanted_) {
      states_[k] = load_state(pipeline_.folder / rules_[k].state);
      reasons_[k] = settings_.force ? "it is forced" : reason_to_run(plans_[k], states_[k], hashes);
      for (const std::size_t need : needs_[k])
        if (reasons_[k].empty() && must_run(need)) reasons_[k] = rules_[need].run.name + " runs again";
    }
    bytes_read_ = hashes.bytes_read();
  }

  /// Lists the rules of the stages that an asset should pass.
  std::vector<std::size_t> rules_until(const std::string& asset) const {
    const std::size_t last = stage_position(settings_.until).value_or(all_stages().size());
    std::vector<std::size_t> rules;
    // Rules that make the mesh are no stage, and come before all of them.
    for (std::size_t k = 0; k < rules_.size(); ++k)
      if (rules_[k].asset == asset && stage_position(rules_[k].run.name).value_or(0) <= last) rules.push_back(k);
    return rules;
  }

  /// Adds a rule to `wanted_`, after all that it needs.
  void want(std::size_t rule) {
    if (std::find(wanted_.begin(), wanted_.end(), rule) != wanted_.end()) return;
    for (const std::size_t need : needs_[rule]) want(need);
    wanted_.push_back(rule);
  }

  void say_what_would_run() {
    for (const std::size_t k : wanted_) {
      const StageRun& run = rules_[k].run;
      if (!settings_.json && must_run(k))
        std::printf("[%s] %s: %s\n", rules_[k].asset.c_str(), run.name.c_str(),
                    shown_command(run.whole_command()).c_str());
      note(k, must_run(k) ? "to build" : "current");
    }
    if (!settings_.json && std::none_of(wanted_.begin(), wanted_.end(), [&](std::size_t k) { return must_run(k); }))
      std::printf("nothing to do\n");
  }

  /// Removes the states, so that every step has to run.
  void forget() {
    for (const std::size_t k : wanted_) {
      std::error_code error;
      fs::remove(pipeline_.folder / rules_[k].state, error);
      fs::remove((pipeline_.folder / rules_[k].state).string() + ".begun", error);
      states_[k].reset();
    }
  }

  void save_plans() {
    for (std::size_t k = 0; k < rules_.size(); ++k) save_plan(pipeline_.folder / rules_[k].plan, plans_[k]);
    // Keeps the new stamps, which save the next build from reading files again; for a few bytes this is not worth a
    // write.
    constexpr std::int64_t much = 16 << 20;
    for (const std::size_t k : wanted_)
      if (bytes_read_ > much && states_[k] && !must_run(k)) save_state(pipeline_.folder / rules_[k].state, *states_[k]);
    write_if_changed(pipeline_.folder / pipeline_.output / "Makefile", makefile_text(rules_, program_folder()));
  }

  void run_stages() {
    const std::vector<std::string> targets = targets_of(rules_);
    std::set<std::string> busy;
    MakeSettings make;
    make.folder = pipeline_.folder;
    make.makefile = pipeline_.output / "Makefile";
    for (const std::size_t k : wanted_)
      if (must_run(k)) busy.insert(rules_[k].asset);
    for (const Asset* asset : buildable_)
      for (const std::size_t rule : rules_until(asset->name)) make.targets.push_back(targets[rule]);
    // Assets side by side share the cores: within one, each stage waits for the one before.
    const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    make.jobs = settings_.jobs > 0 ? settings_.jobs : cores;
    const int side_by_side = std::min(make.jobs, static_cast<int>(busy.size()));
    make.threads = std::max(1, cores / side_by_side);
    make.keep_going = settings_.keep_going;
    make.alone = side_by_side == 1;
    const MakeEnd end = run_make(make);
    throw_if_interrupted();
    take(end);
  }

  /// Takes over what make reports about the stages.
  void take(const MakeEnd& make) {
    std::map<std::pair<std::string, std::string>, StepEvent> events;
    bool failed = false;
    for (const StepEvent& event : make.events) {
      events[{event.asset, event.stage}] = event;
      failed |= event.status != 0 && event.status != missed_budget;
    }
    if (!make.end.succeeded() && !failed) fail_as_make(make);
    for (const std::size_t k : wanted_) {
      const auto event = events.find({rules_[k].asset, rules_[k].run.name});
      if (event == events.end()) {
        note(k, !must_run(k) ? "current" : make.end.succeeded() ? "current" : "not reached");
        continue;
      }
      const bool good = event->second.status == 0 || event->second.status == missed_budget;
      StageOutcome* outcome = note(k, good ? "built" : "failed");
      if (!good) statuses_.push_back(event->second.status);
      if (outcome == nullptr) continue;
      outcome->status = event->second.status;
      outcome->seconds = event->second.seconds;
    }
    noted_ = true;
  }

  /// Adds the outcome of one rule; null for an asset that was not asked for.
  StageOutcome* note(std::size_t rule, const char* state) {
    const auto asset = std::find_if(outcomes_.begin(), outcomes_.end(),
                                    [&](const AssetOutcome& outcome) { return outcome.name == rules_[rule].asset; });
    if (asset == outcomes_.end()) return nullptr;
    asset->stages.push_back({rules_[rule].run.name, state, reasons_[rule], 0, 0});
    return &asset->stages.back();
  }

  /// Reports, for each complete asset, where its report is and whether it meets the budgets.
  void judge_all() {
    if (!noted_)
      for (const std::size_t k : wanted_) note(k, "current");
    const bool stopped = !statuses_.empty() && !settings_.keep_going;
    for (AssetOutcome& asset : outcomes_) {
      for (const StageOutcome& stage : asset.stages)
        if (stage.state == "failed") asset.status = stage.status;
      const bool whole = std::all_of(asset.stages.begin(), asset.stages.end(), [](const StageOutcome& stage) {
        return stage.state == "built" || stage.state == "current";
      });
      if (!whole || stopped || asset.stages.empty()) continue;
      if (asset.stages.back().stage == "report")
        judge(asset);
      else if (!settings_.quiet)
        std::fprintf(stderr, "[%s] built as far as %s: %s\n", asset.name.c_str(), asset.stages.back().stage.c_str(),
                     asset.folder.c_str());
    }
  }

  /// Reports where the asset's report is and whether it met the budgets.
  void judge(AssetOutcome& asset) {
    const fs::path folder = asset.folder;
    const Json metrics = Json::parse(read_text(folder / report_metrics));
    asset.report = (folder / layout::report_page).string();
    asset.budgets = metrics.at("report").at("budgets");
    int missed = 0;
    for (const Json& budget : asset.budgets) {
      if (budget.at("met").get<bool>()) continue;
      ++missed;
      const double limit = budget.at("limit").get<double>();
      const Json& value = budget.at("value");
      std::fprintf(stderr, "kiln: asset '%s' misses a budget: %s is %s, expected %s %s\n", asset.name.c_str(),
                   budget.at("metric").get<std::string>().c_str(),
                   value.is_number() ? measure_text(value.get<double>(), limit).c_str() : "no number",
                   budget.at("relation").get<std::string>().c_str(), measure_text(limit, limit).c_str());
    }
    const std::size_t count = asset.budgets.size();
    const std::string verdict = count == 0    ? "no budgets"
                                : missed == 0 ? fmt::format("{} of {} budgets met", count, count)
                                              : fmt::format("{} of {} budgets missed", missed, count);
    if (!settings_.quiet)
      std::fprintf(stderr, "[%s] report: %s (%s)\n", asset.name.c_str(), asset.report.c_str(), verdict.c_str());
    if (missed > 0) asset.status = missed_budget;
  }

  int finish() {
    for (const AssetOutcome& asset : outcomes_) statuses_.push_back(asset.status);
    const int status = gravest_status(statuses_);
    if (settings_.json) std::printf("%s\n", json_text(to_json(outcomes_, status, watch_.seconds())).c_str());
    return status;
  }

  const Pipeline& pipeline_;
  const BuildSettings& settings_;
  const Stopwatch watch_;
  std::vector<AssetOutcome> outcomes_;  ///< one for each asset that was asked for
  std::vector<const Asset*> buildable_;
  std::vector<MakeRule> rules_;
  std::vector<std::vector<std::size_t>> needs_;
  std::vector<StagePlan> plans_;                   ///< one for each rule
  std::vector<std::optional<StageState>> states_;  ///< one for each rule; set if the rule is wanted
  std::vector<std::string> reasons_;               ///< why each rule has to run; empty if it does not
  std::vector<std::size_t> wanted_;                ///< rules, each after those that it needs
  std::vector<int> statuses_;
  std::int64_t bytes_read_ = 0;  ///< in finding out what has changed
  bool noted_ = false;
};

}  // namespace

int gravest_status(const std::vector<int>& statuses) {
  constexpr int by_gravity[] = {5, 3, 2, 4, 0};
  int gravest = 0;
  const auto rank = [&](int status) {
    return std::find(std::begin(by_gravity), std::end(by_gravity), status) - std::begin(by_gravity);
  };
  for (const int status : statuses)
    // A status that is not in the list is a defect, graver than all others.
    if (rank(status) == std::ssize(by_gravity))
      return static_cast<int>(ExitCode::failed);
    else if (rank(status) < rank(gravest))
      gravest = status;
  return gravest;
}

void write_index(const Pipeline& pipeline) {
  const fs::path folder = pipeline.folder / pipeline.output;
  std::vector<IndexEntry> entries;
  bool any = false;
  for (const Asset& asset : pipeline.assets) {
    std::error_code error;
    IndexEntry& entry = entries.emplace_back();
    entry.name = asset.name;
    entry.metrics = metrics_of_asset(folder / asset.name);
    entry.has_picture = fs::is_regular_file(folder / asset.name / report_cover, error);
    any |= entry.metrics.is_object();
  }
  std::error_code error;
  if (!any && !fs::exists(folder / "index.html", error)) return;
  const std::string title = fs::absolute(pipeline.folder / pipeline.output).lexically_normal().filename().string();
  write_if_changed(folder / "index.html", index_html(title.empty() ? "Assets" : title, entries));
}

int build(const Pipeline& pipeline, const std::vector<const Asset*>& assets, const BuildSettings& settings) {
  return Build(pipeline, settings).run(assets);
}

}  // namespace kiln
