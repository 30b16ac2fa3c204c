// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/sweep/sweep.h"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <optional>
#include <set>

#include "base/errors.h"
#include "base/files.h"
#include "base/hashes.h"
#include "base/interruption.h"
#include "base/process.h"
#include "base/stopwatch.h"
#include "kiln/build.h"
#include "kiln/overrides.h"
#include "kiln/rules.h"
#include "kiln/sweep/sweep_page.h"
#include "kiln/sweep/sweep_result.h"
#include "kiln/text_file.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

std::vector<SweepPoint> points_of(const SweepSettings& settings) {
  std::vector<SweepAxis> axes;
  for (const std::string& text : settings.axes) axes.push_back(parse_axis(text));
  std::vector<SweepPoint> points = {{"today", {}}};
  if (!axes.empty()) {
    const std::vector<SweepPoint> grid = grid_points(axes);
    points.insert(points.end(), grid.begin(), grid.end());
  }
  if (settings.historic) {
    const std::vector<SweepPoint> historic = historic_points();
    points.insert(points.end(), historic.begin(), historic.end());
  }
  return points;
}

class Sweep {
 public:
  Sweep(const Pipeline& pipeline, const std::vector<const Asset*>& assets, const SweepSettings& settings)
      : pipeline_(pipeline),
        settings_(settings),
        folder_(settings.output.empty() ? pipeline.folder / pipeline.output / sweep_folder : settings.output),
        points_(points_of(settings)),
        programs_(program_folder()),
        inputs_(pipeline.folder) {
    for (const Asset* asset : assets) {
      names_.push_back(asset->name);
      require_effect(*asset);
    }
    for (const SweepPoint& point : points_) pipeline_at(pipeline_, point);  // throws before the first build
    // Builds of all points share one folder beside the results.
    pipeline_.output = fs::absolute(folder_ / "build").lexically_normal();
  }

  int run() {
    fs::create_directories(folder_ / "points");
    for (std::size_t k = 0; k < points_.size(); ++k) {
      measure(points_[k]);
      throw_if_interrupted();
      save();
      tell(k + 1);
    }
    if (settings_.json) std::printf("%s\n", json_text(sweep_json(results_)).c_str());
    const bool any = std::ranges::any_of(results_, [](const SweepResult& result) { return result.status == 0; });
    return any ? 0 : gravest_status(statuses_);
  }

 private:
  /// Throws WrongUsage where an axis would change nothing of an asset.
  void require_effect(const Asset& asset) const {
    for (const SweepPoint& point : points_)
      for (const auto& [name, value] : point.settings)
        if (is_moot(asset, name))
          throw WrongUsage(
              fmt::format("set: found {}, and asset '{}' with a low mesh of its own, which is not simplified; expected "
                          "other settings, or the names of other assets",
                          name, asset.name));
  }

  /// Measures all assets at one point.
  void measure(const SweepPoint& point) {
    const Pipeline there = pipeline_at(pipeline_, point);
    std::vector<std::string> missing;
    for (const std::string& name : names_) {
      const fs::path file = file_of(there, name);
      if (std::optional<SweepResult> known = load(file)) {
        known->point = point;
        results_.push_back(*known);
      } else {
        missing.push_back(name);
      }
    }
    if (missing.empty()) {
      ++reused_;
      return;
    }
    const Stopwatch watch;
    BuildSettings build_settings;
    build_settings.jobs = settings_.jobs;
    build_settings.quiet = true;
    build_settings.keep_going = true;
    build_settings.until = settings_.until;
    for (const std::string& name : missing) {
      // One asset at a time, so that a failure is its own.
      const int status = build(there, select_assets(there, {name}), build_settings);
      SweepResult result;
      result.metrics = Json::object();
      // Where a stage fails, records of an earlier point are still there.
      if (status == 0) result = read_result(name, point, there.output / name, stages_of(there, name));
      result.asset = name;
      result.point = point;
      result.status = status;
      results_.push_back(result);
      statuses_.push_back(status);
      if (status == 0) write_if_changed(file_of(there, name), json_text(to_json(result), 2) + "\n");
    }
    seconds_ += watch.seconds();
    ++built_;
  }

  /// Lists the stages that an asset passes, up to the last one asked for.
  std::vector<std::string> stages_of(const Pipeline& there, const std::string& name) const {
    const std::size_t last = stage_position(settings_.until).value_or(all_stages().size());
    const auto asset = std::ranges::find(there.assets, name, &Asset::name);
    std::vector<std::string> stages;
    for (const std::string& stage : stage_names())
      if (asset->settings.contains(stage) && stage_position(stage).value_or(0) <= last) stages.push_back(stage);
    return stages;
  }

  /// Names the file of a result by everything that it depends on: commands, programs, and the content of the files that
  /// no stage makes.
  fs::path file_of(const Pipeline& there, const std::string& asset) {
    std::string text = settings_.until + "\n";
    std::set<fs::path> made;
    const std::vector<MakeRule> rules = make_rules(there);
    for (const MakeRule& rule : rules) made.insert(rule.run.outputs.begin(), rule.run.outputs.end());
    const std::size_t last = stage_position(settings_.until).value_or(all_stages().size());
    for (const MakeRule& rule : rules) {
      if (rule.asset != asset || stage_position(rule.run.name).value_or(0) > last) continue;
      text += stamp_text(rule.run, programs_);
      for (const fs::path& input : rule.run.inputs)
        if (!made.contains(input))
          if (const std::optional<FileStamp> stamp = inputs_.stamp(input)) text += stamp->hash + "\n";
    }
    const std::string hash = hash_bytes({std::as_bytes(std::span(text))});
    return folder_ / "points" / fs::path(asset + "-" + hash.substr(0, 16) + ".json");
  }

  static std::optional<SweepResult> load(const fs::path& file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return std::nullopt;
    try {
      return sweep_result_of_json(Json::parse(read_text(file)));
    } catch (const Json::exception&) {
      return std::nullopt;  // is measured again
    }
  }

  void save() const {
    write_if_changed(folder_ / "sweep.json", json_text(sweep_json(results_), 2) + "\n");
    write_if_changed(folder_ / "sweep.csv", sweep_csv(results_));
    write_if_changed(folder_ / "sweep.html", sweep_html(results_));
  }

  /// Says how far the sweep is, and how long it will go on if the points to come take as long as those built so far.
  void tell(std::size_t done) const {
    if (settings_.quiet) return;
    const std::size_t left = points_.size() - done;
    std::string text = fmt::format("kiln: point {} of {}", done, points_.size());
    if (reused_ > 0) text += fmt::format(", {} measured earlier", reused_);
    if (left > 0 && built_ > 0)
      text += fmt::format(", about {:.0f} s left", seconds_ / static_cast<double>(built_) * static_cast<double>(left));
    if (left == 0) text += fmt::format("; {}", (folder_ / "sweep.html").lexically_normal().string());
    std::fprintf(stderr, "%s\n", text.c_str());
  }

  Pipeline pipeline_;
  const SweepSettings& settings_;
  const fs::path folder_;
  const std::vector<SweepPoint> points_;
  FileHashes programs_, inputs_;
  std::vector<std::string> names_;  ///< of the assets
  std::vector<SweepResult> results_;
  std::vector<int> statuses_;
  double seconds_ = 0;  ///< of the points built
  std::size_t built_ = 0, reused_ = 0;
};

}  // namespace

int sweep(const Pipeline& pipeline, const std::vector<const Asset*>& assets, const SweepSettings& settings) {
  if (!settings.until.empty() && find_stage(settings.until) == nullptr)
    throw WrongUsage(fmt::format("until: found '{}'; expected a stage", settings.until));
  return Sweep(pipeline, assets, settings).run();
}

}  // namespace kiln
