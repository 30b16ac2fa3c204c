// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/plan/plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <optional>

#include "base/errors.h"
#include "base/json.h"
#include "kiln/overrides.h"
#include "kiln/plan/pilot.h"
#include "kiln/plan/plan_file.h"
#include "kiln/presets.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr double share_of_compression = 0.5;  // of E, a quarter of its square

/// Settings that a plan decides, except those of simplification's price.
const std::vector<std::string> decided = {"simplify.faces",     "simplify.quality", "simplify.aware", "atlas.size",
                                          "bake.bands",         "bake.directions",  "bake.bits",      "bake.bounces",
                                          "compress.max-error", "bake.per-vertex",  "bake.shadows"};

/// Returns E asked for of an asset: that of the command, or the asset's budget.
double asked_of(const Asset& asset, const PlanSettings& settings) {
  if (settings.error > 0) return settings.error;
  if (settings.levels > 0) return error_of_levels(settings.levels);
  const std::string prefix = std::string(error_metric) + "<=";
  for (const std::string& budget : asset.budgets)
    if (budget.starts_with(prefix)) return std::stod(budget.substr(prefix.size()));
  throw WrongUsage(
      fmt::format("plan: found no error for '{}'; expected --error, --levels, or a budget for {} in the "
                  "pipeline",
                  asset.name, error_metric));
}

/// Returns why nothing can be planned for an asset; empty if something can.
std::string reason_to_leave(const Asset& asset) {
  if (effective_setting(asset.settings, "bake", "subsurface") != "none")
    return "subsurface: light scatters beneath its surface, and how much of its error is from directions is not known";
  return {};
}

int kept_number(const Asset& asset, const std::string& stage, const std::string& setting) {
  const Json value = effective_setting(asset.settings, stage, setting);
  if (!value.is_number_integer())
    throw WrongUsage(fmt::format("keep: found {}.{} of '{}', which is {}; expected a whole number", stage, setting,
                                 asset.name, value.dump()));
  return value.get<int>();
}

std::vector<int> without_zero(std::vector<int> values) {
  std::erase(values, 0);
  return values;
}

/// Decides the settings of one asset.
class AssetPlanner {
 public:
  AssetPlanner(const Asset& asset, Pilot pilot, PilotBuilds& builds, const PlanGoal& goal, const PlanSettings& settings)
      : asset_(asset), model_(std::move(pilot)), builds_(builds), goal_(goal), settings_(settings) {}

  /// Returns the plan; without lines where the error cannot be kept, and then `prediction` is of the best there is.
  PlannedAsset decide() {
    if (model_.pilot().must_be_vertices && !model_.pilot().may_be_vertices)
      return {asset_.name, goal_.error, "per-vertex: what its albedo or opacity costs at vertices is not known",
              {},          {},          {}};
    if (keeps("bake.shadows") && !has_shadows(asset_) && !model_.pilot().may_be_unshadowed)
      return {asset_.name, goal_.error, "shadows: what leaving them out costs is not known", {}, {}, {}};
    ChoiceGrid grid = full_grid(model_);
    keep_in(grid);
    double allowance = asset_.settings.contains("compress") ? share_of_compression * goal_.error : 0;
    std::optional<PlannedChoice> best = cheapest(model_, choices_of(grid, allowance), goal_);
    // Measure compression with the bands chosen, and choose the rest anew; if that is too much error, halve its share.
    for (int tries = 0; tries < 2 && best && allowance > 0; ++tries) {
      ChoiceGrid rest = grid;
      rest.bands = {best->choice.bands};
      allowance = compress_pilot(best->choice.bands, allowance);
      const std::optional<PlannedChoice> better = cheapest(model_, choices_of(rest, allowance), goal_);
      if (better || tries == 1 || keeps("compress.max-error")) {
        best = better;
        break;
      }
      allowance /= 2;
    }
    PlannedAsset planned{asset_.name, goal_.error, "", {}, {}, {}};
    if (best) {
      planned.prediction = best->prediction;
      planned.lines = lines_of(best->choice);
      planned.of_final = model_.predict(final_choice(allowance));
      return planned;
    }
    const PlannedChoice closest =
        most_accurate(model_, choices_of(grid, allowance), PlanGoal{}).value_or(PlannedChoice{});
    planned.prediction = closest.prediction;
    return planned;
  }

 private:
  bool keeps(const std::string& setting) const {
    return std::ranges::find(settings_.keep, setting) != settings_.keep.end();
  }

  void keep_in(ChoiceGrid& grid) const {
    if (keeps("simplify.faces") && !model_.pilot().has_own_low)
      grid.triangles = {kept_number(asset_, "simplify", "faces")};
    const bool has_atlas = !model_.pilot().must_be_vertices;
    if (keeps("atlas.size") && has_atlas) grid.sizes = {kept_number(asset_, "atlas", "size")};
    if ((keeps("atlas.size") || keeps("bake.per-vertex")) && has_atlas) grid.per_vertex = {false};
    if (keeps("bake.bands")) grid.bands = {kept_number(asset_, "bake", "bands")};
    if (keeps("bake.shadows")) grid.directions = has_shadows(asset_) ? without_zero(grid.directions) : std::vector{0};
    if (keeps("bake.directions")) grid.directions = {kept_number(asset_, "bake", "directions")};
    if (keeps("bake.bits")) grid.bits = {kept_number(asset_, "bake", "bits")};
    if (keeps("bake.bounces") && model_.pilot().has_bounces) grid.bounces = {true};
  }

  /// Compresses a pilot, a second time where its error, in the light expected, is far from what it may be. Returns the
  /// E that kiln-compress is to keep.
  double compress_pilot(int bands, double allowance) {
    if (keeps("compress.max-error")) allowance = kept_allowance();
    Pilot pilot = model_.pilot();
    pilot.is_compressed = true;
    pilot.compressed = builds_.build_compressed(asset_, bands, allowance, settings_.keep);
    const double wanted = allowance, measured = error_of(pilot.compressed, "compression", bands);
    if (!keeps("compress.max-error") && measured > 0 && std::abs(std::log(wanted / measured)) > std::log(1.3)) {
      allowance = std::clamp(allowance * wanted / measured, 1e-5, 0.5);
      pilot.compressed = builds_.build_compressed(asset_, bands, allowance, settings_.keep);
    }
    model_ = AssetModel(std::move(pilot));
    return allowance;
  }

  double kept_allowance() const {
    const Json value = effective_setting(asset_.settings, "compress", "max-error");
    if (!value.is_number() && !(value.is_string() && value.get<std::string>() != "auto"))
      throw WrongUsage(
          fmt::format("keep: found compress.max-error of '{}', which is auto; expected a number", asset_.name));
    return value.is_number() ? value.get<double>() : std::stod(value.get<std::string>());
  }

  /// Returns the preset `final` as a choice, as far as the pilot's bands reach.
  Choice final_choice(double allowance) const {
    const int triangles = model_.pilot().has_own_low ? static_cast<int>(model_.pilot().fine.triangles) : 1000;
    Choice choice{triangles, 512, 5, 1024, 8, model_.pilot().has_bounces, allowance, model_.pilot().must_be_vertices};
    for (const auto& [name, value] : find_preset("final")->settings) {
      if (name == "simplify.faces" && !is_moot(asset_, name)) choice.triangles = std::stoi(value);
      if (name == "atlas.size") choice.size = std::stoi(value);
      if (name == "bake.bands") choice.bands = std::min(std::stoi(value), model_.most_bands());
      if (name == "bake.directions") choice.directions = std::stoi(value);
      if (name == "bake.bits") choice.bits = std::stoi(value);
    }
    return choice;
  }

  /// Lists the settings of a choice, each with what it costs of the error.
  std::vector<PlanLine> lines_of(const Choice& choice) const {
    const Prediction at = model_.predict(choice);
    const auto costs = [&](const char* cause) {
      const auto found = at.causes.find(cause);
      return fmt::format("{:.2g} % of error", found == at.causes.end() ? 0 : 100 * found->second);
    };
    std::vector<PlanLine> lines;
    const auto add = [&](const std::string& setting, const std::string& value, const std::string& reason) {
      if (!keeps(setting) && !is_moot(asset_, setting)) lines.push_back({setting, value, reason});
    };
    const bool is_whole = choice.triangles >= model_.pilot().input_triangles;
    add("simplify.faces", std::to_string(choice.triangles),
        costs("geometry") + (is_whole ? "; all of the high mesh" : ""));
    add("simplify.quality", "standard", "seconds less than best, for some more triangles");
    add("simplify.aware", "none", "");
    if (choice.per_vertex)
      add("bake.per-vertex", "true", costs("vertices") + "; no atlas, no maps");
    else
      add("atlas.size", std::to_string(choice.size),
          fmt::format("{} at texels, {:.2g} % at seams", costs("texels"), 100 * at.causes.at("seams")));
    add("bake.bands", std::to_string(choice.bands), costs("bands") + why_bands());
    if (choice.directions == 0) {
      add("bake.shadows", "none", costs("shadows") + ": what they are");
    } else {
      if (!has_shadows(asset_)) add("bake.shadows", "cast", "too much is lost without them");
      add("bake.directions", std::to_string(choice.directions), costs("directions"));
    }
    if (effective_setting(asset_.settings, "bake", "max-error") != "none")
      add("bake.max-error", "none", "the plan has decided");
    add("bake.sampling", "fibonacci", "the most even one");
    add("bake.bits", std::to_string(choice.bits), costs("bits"));
    add("bake.adaptive", "0", "");
    if (model_.pilot().has_bounces)
      add("bake.bounces", choice.bounces ? asset_.settings.at("bake").at("bounces") : "0",
          costs("bounces") + (choice.bounces ? "" : ": what bounces would add"));
    if (choice.compression > 0)
      add("compress.max-error", fmt::format("{:.4g}", choice.compression),
          costs("compression") + " in the light expected");
    if (!choice.bounces && model_.pilot().has_bounces)
      lines.push_back({"report.error-bounces", bounces_of_pilot(), "so that what is left out is measured"});
    return lines;
  }

  std::string why_bands() const {
    return effective_setting(asset_.settings, "report", "error-lights") == "measured" ? " under light of docs/error.md"
                                                                                      : " under report.error-lights";
  }

  std::string bounces_of_pilot() const { return std::to_string(builds_.bounces_of(asset_.name)); }

  const Asset& asset_;
  AssetModel model_;
  PilotBuilds& builds_;
  const PlanGoal goal_;
  const PlanSettings& settings_;
};

/// Returns what is known of an asset's colours; nothing where the machine lacks the CIE's spectra and no lamp was
/// named.
std::optional<ColorHint> color_of(const Pipeline& pipeline, const Asset& asset, const PlanSettings& settings) {
  try {
    return color_hint(pipeline, asset, settings.color);
  } catch (const MachineLacks&) {
    if (settings.names_lights) throw;
    return std::nullopt;
  }
}

PlanGoal goal_of(const Asset& asset, const PlanSettings& settings) {
  PlanGoal goal;
  goal.error = asked_of(asset, settings);
  if (settings.bytes > 0) goal.bytes = settings.bytes;
  if (settings.seconds > 0) goal.seconds = settings.seconds;
  goal.cost = settings.least == "seconds" ? PlanCost::seconds
              : settings.least == "bytes" ? PlanCost::bytes
                                          : PlanCost::both;
  return goal;
}

Json to_json(const std::vector<PlannedAsset>& assets, double pilot_seconds) {
  Json list = Json::array();
  for (const PlannedAsset& asset : assets) {
    Json entry = {{"name", asset.name}, {"asked", asset.asked}};
    if (!asset.left_alone.empty()) {
      entry["left_alone"] = asset.left_alone;
    } else {
      entry["kept"] = !asset.lines.empty();
      entry["settings"] = Json::object();
      for (const PlanLine& line : asset.lines) entry["settings"][line.setting] = line.value;
      entry["predicted"] = asset.prediction.causes;
      entry["predicted"]["total"] = asset.prediction.error;
      entry["cpu_seconds"] = asset.prediction.cpu_seconds;
      entry["bytes"] = asset.prediction.bytes;
    }
    if (asset.color) entry["color"] = to_json(*asset.color);
    list.push_back(entry);
  }
  return {{"assets", list}, {"pilot_cpu_seconds", pilot_seconds}};
}

/// Says what an asset can reach, and what stands in the way.
void tell_missed(const PlannedAsset& asset) {
  if (asset.prediction.causes.empty()) {
    std::fprintf(stderr, "kiln: asset '%s': no settings keep those bytes and seconds\n", asset.name.c_str());
    return;
  }
  const auto largest =
      std::ranges::max_element(asset.prediction.causes, {}, [](const auto& cause) { return cause.second; });
  std::fprintf(stderr,
               "kiln: asset '%s': found no settings of a predicted error under %.3g %%; the least is %.3g %%, of which "
               "%.3g %% are %s; expected a larger --error, more bytes or seconds%s\n",
               asset.name.c_str(), 100 * asset.asked, 100 * asset.prediction.error, 100 * largest->second,
               largest->first.c_str(),
               largest->first == "bands" ? ", or softer light: report.error-lights says what is expected" : "");
}

void tell(const PlannedAsset& asset) {
  if (asset.color) std::fprintf(stderr, "[%s] %s\n", asset.name.c_str(), to_text(*asset.color).c_str());
  if (!asset.left_alone.empty()) {
    std::fprintf(stderr, "kiln: asset '%s' stays as it is: %s\n", asset.name.c_str(), asset.left_alone.c_str());
    return;
  }
  std::string text =
      fmt::format("[{}] asked {:.3g} %, predicted {:.3g} %, {:.2g} CPU s, {:.0f} kB", asset.name, 100 * asset.asked,
                  100 * asset.prediction.error, asset.prediction.cpu_seconds, asset.prediction.bytes / 1000);
  if (asset.of_final && asset.prediction.cpu_seconds > 0)
    text += fmt::format("; final: {:.2g} CPU s, {:.0f} kB", asset.of_final->cpu_seconds, asset.of_final->bytes / 1000);
  std::fprintf(stderr, "%s\n", text.c_str());
}

}  // namespace

double error_of_levels(double levels) {
  // The sRGB curve above its foot is 1.055 x^(1/2.4) - 0.055 [IEC 61966-2-1]; its slope times x is what a relative
  // change of x does.
  constexpr double mid_grey = 0.2;
  return levels / 255 / (1.055 / 2.4 * std::pow(mid_grey, 1 / 2.4));
}

int plan(const Pipeline& pipeline, const std::vector<const Asset*>& assets, const PlanSettings& settings) {
  for (const std::string& name : settings.keep)
    if (std::ranges::find(decided, name) == decided.end())
      throw WrongUsage(fmt::format("keep: found '{}'; expected one of {}", name, fmt::join(decided, ", ")));
  std::vector<PlannedAsset> planned;
  std::vector<const Asset*> to_plan;
  std::vector<std::optional<ColorHint>> colors;  // before pilots: a mistyped lamp should not cost their time
  for (const Asset* asset : assets) {
    colors.push_back(color_of(pipeline, *asset, settings));
    const double asked = asked_of(*asset, settings);
    const std::string reason = reason_to_leave(*asset);
    if (reason.empty()) to_plan.push_back(asset);
    planned.push_back({asset->name, asked, reason, {}, {}, {}});
  }
  PilotBuilds builds(pipeline, pipeline.folder / pipeline.output / pilots_folder, settings.jobs, settings.quiet);
  if (!to_plan.empty()) {
    std::map<std::string, Pilot> pilots = builds.build(to_plan, settings.keep);
    for (const Asset* asset : to_plan)
      *std::ranges::find(planned, asset->name, &PlannedAsset::name) =
          AssetPlanner(*asset, pilots.at(asset->name), builds, goal_of(*asset, settings), settings).decide();
  }
  for (std::size_t k = 0; k < planned.size(); ++k) planned[k].color = std::move(colors[k]);
  if (settings.json) std::printf("%s\n", json_text(to_json(planned, builds.cpu_seconds())).c_str());
  const auto is_missed = [](const PlannedAsset& asset) { return asset.left_alone.empty() && asset.lines.empty(); };
  for (const PlannedAsset& asset : planned)
    if (is_missed(asset)) tell_missed(asset);
  if (std::ranges::any_of(planned, is_missed)) return static_cast<int>(ExitCode::budget_missed);
  if (!settings.quiet)
    for (const PlannedAsset& asset : planned) tell(asset);
  const fs::path from = fs::absolute(settings.output).parent_path();
  write_plan(settings.output, fs::absolute(pipeline.file).lexically_proximate(from), planned, builds.cpu_seconds());
  return 0;
}

}  // namespace kiln
