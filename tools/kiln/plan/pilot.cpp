// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/plan/pilot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <limits>

#include "asset/shipped.h"
#include "base/asset_layout.h"
#include "base/errors.h"
#include "base/files.h"
#include "base/json.h"
#include "kiln/build.h"
#include "kiln/metrics.h"
#include "kiln/text_file.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr int most_atlas_factor = 16;
constexpr int pilot_bands = 8;  // more where a kept number of bands asks for them
const Overrides coarse_settings = {{"simplify.faces", "500"}, {"atlas.size", "64"}, {"bake.directions", "256"}};
const Overrides fine_settings = {{"simplify.faces", "2000"}, {"atlas.size", "128"}, {"bake.directions", "1024"}};

/// Settings of all pilots: the cheapest simplification that is near to its best, few turns of charts, no verification,
/// few samples of the error, pictures as small as they can be.
const Overrides common_settings = {{"simplify.quality", "standard"},
                                   {"simplify.aware", "none"},
                                   {"atlas.rotations", "4"},
                                   {"bake.bands", std::to_string(pilot_bands)},
                                   {"bake.bits", "8"},
                                   {"bake.adaptive", "0"},
                                   {"bake.max-error", "none"},
                                   {"bake.verify-directions", "0"},
                                   {"report.picture-size", "64"},
                                   {"report.cameras", "1"},
                                   {"report.directions", "16"},
                                   {"report.lights", "ambient:1"},
                                   {"report.error-samples", "1024"},
                                   {"report.error-others", "true"}};

/// Returns settings of an asset's pilots whose bands stay as the pipeline has them, where those are more than those of
/// other pilots: the bands, and directions that keep them apart.
Overrides settings_of_many_bands(const Asset& asset, const Overrides& of_build) {
  const Json given = effective_setting(asset.settings, "bake", "bands");
  const int bands = given.is_number_integer() ? given.get<int>() : 0;
  if (bands <= pilot_bands) return {};
  Overrides settings = {{"bake.bands", std::to_string(bands)}};
  for (const auto& [name, value] : of_build) {
    if (name != "bake.directions") continue;
    // As many for each coefficient as the pilot of fewer bands has.
    const int directions = std::stoi(value) * bands * bands / (pilot_bands * pilot_bands);
    settings.emplace_back(name, std::to_string(directions));
  }
  return settings;
}

Json record_of(const fs::path& asset, const std::string& stage) {
  return Json::parse(read_text(layout::record(asset, stage)));
}

double bytes_of(const fs::path& file) {
  std::error_code error;
  const auto bytes = fs::file_size(file, error);
  return error ? 0 : static_cast<double>(bytes);
}

/// Reads what a build of an asset measured; `last` is the stage that makes what ships.
PilotBuild read_build(const fs::path& asset, const std::string& last) {
  PilotBuild result;
  const Json atlas = record_of(asset, "atlas"), bake = record_of(asset, "bake"), report = record_of(asset, "report");
  const Json simplify = record_of(asset, "simplify");
  result.triangles = simplify.at("triangles").get<double>();
  result.vertices = simplify.at("vertices").get<double>();
  result.size = std::sqrt(atlas.at("width").get<double>() * atlas.at("height").get<double>());
  result.texels = atlas.at("covered_texels").get<double>();
  result.directions = bake.at("directions").get<double>();
  result.cache_points = bake.value("bounces", Json::object()).value("cache_points", 0.0);
  result.bands = static_cast<int>(std::lround(std::sqrt(bake.at("coefficients").get<double>())));
  const Json& error = report.at("error");
  if (!error.at("total").is_number())
    throw BadInput(asset.string(), "a pilot without a point at which its error could be measured",
                   "a surface that is seen", "look at its report");
  result.total = error.at("total").get<double>();
  result.uncertainty = error.at("uncertainty").get<double>();
  result.root_sum = error.at("root_sum_of_causes").get<double>();
  for (const auto& [cause, squares] : error.at("squares_by_band").items())
    if (cause != "total") (cause == "seen" ? result.seen : result.squares[cause]) = squares.get<std::vector<double>>();
  const auto other = [&](const char* name) {
    const auto found = error.find(name);
    return found == error.end() ? std::vector<double>() : found->at("squares_by_band").get<std::vector<double>>();
  };
  result.at_vertices = other("at_vertices");
  result.unshadowed = other("unshadowed");
  for (const char* stage : {"simplify", "atlas", "normals", "bake", "compress"})
    if (std::error_code code; fs::is_regular_file(layout::record(asset, stage), code))
      result.cpu_seconds[stage] = record_of(asset, stage).at("cpu_seconds").get<double>();
  const fs::path shipped = layout::stage_folder(asset, last);
  result.mesh_bytes = bytes_of(shipped / layout::atlas_mesh);
  result.map_bytes = bytes_of(shipped / layout::normal_map) + bytes_of(shipped / layout::albedo_map) +
                     bytes_of(shipped / layout::opacity_map);
  result.plane_bytes = static_cast<double>(shipped_bytes(shipped)) - result.mesh_bytes - result.map_bytes;
  return result;
}

}  // namespace

bool allows(const Asset& asset, const std::string& setting, const std::string& value) {
  try {
    Asset other = asset;
    override_settings(other, {{"bake.adaptive", "0"}, {"bake.max-error", "none"}, {setting, value}}, "a plan's");
    // A budget for what would not be written asks for another value.
    const std::vector<std::string> metrics = metrics_of(other.settings);
    return std::ranges::all_of(asset.budgets, [&](const std::string& budget) {
      return std::ranges::find(metrics, budget.substr(0, budget.find_first_of("<>"))) != metrics.end();
    });
  } catch (const BadInput&) {
    return false;
  }
}

bool has_shadows(const Asset& asset) { return effective_setting(asset.settings, "bake", "shadows") != "none"; }

bool has_bounces(const Asset& asset) {
  const auto bake = asset.settings.find("bake");
  if (bake == asset.settings.end()) return false;
  const auto bounces = bake->second.find("bounces");
  return bounces != bake->second.end() && bounces->second != "0";
}

PilotBuilds::PilotBuilds(const Pipeline& pipeline, fs::path folder, int jobs, bool quiet)
    : pipeline_(pipeline), folder_(std::move(folder)), jobs_(jobs), quiet_(quiet) {}

Pipeline PilotBuilds::pipeline_at(const std::string& name, const Overrides& overrides, bool compressed,
                                  const std::vector<std::string>& kept) const {
  Pipeline there = pipeline_;
  there.output = fs::absolute(folder_ / name).lexically_normal();
  const auto is_kept = [&](const auto& setting) { return std::ranges::find(kept, setting.first) != kept.end(); };
  for (Asset& asset : there.assets) {
    asset.budgets.clear();
    asset.settings.erase("probes");
    if (!compressed) asset.settings.erase("compress");
    Overrides settings = common_settings;
    if (bakes_vertices(asset.settings)) settings.emplace_back("bake.per-vertex", "false");
    if (!has_shadows(asset)) settings.emplace_back("bake.shadows", "cast");
    settings.insert(settings.end(), overrides.begin(), overrides.end());
    // A way of simplifying that is kept is that of the pilots, too.
    std::erase_if(settings, [&](const auto& setting) {
      return is_kept(setting) && (setting.first == "simplify.quality" || setting.first == "simplify.aware");
    });
    if (std::ranges::find(kept, "bake.bands") != kept.end()) {
      const Overrides many = settings_of_many_bands(asset, overrides);
      settings.insert(settings.end(), many.begin(), many.end());
    }
    if (const auto factor = atlas_factors_.find(asset.name); factor != atlas_factors_.end())
      for (auto& [setting, value] : settings)
        if (setting == "atlas.size") value = std::to_string(std::stoi(value) * factor->second);
    override_settings(asset, settings, "a pilot's");
  }
  return there;
}

bool PilotBuilds::enlarge_missing_atlases(const Pipeline& there, const std::vector<std::string>& names) {
  bool enlarged = false;
  for (const std::string& name : names) {
    const fs::path asset = there.output / name;
    std::error_code code;
    if (!fs::exists(layout::record(asset, "simplify"), code) || fs::exists(layout::record(asset, "atlas"), code))
      continue;
    int& factor = atlas_factors_.try_emplace(name, 1).first->second;
    if (factor >= most_atlas_factor) return false;
    factor *= 2;
    enlarged = true;
    if (!quiet_)
      std::fprintf(stderr, "kiln: asset '%s': its pilots take atlases %d times as large\n", name.c_str(), factor);
  }
  return enlarged;
}

std::vector<PilotBuild> PilotBuilds::build_at(const std::string& name, const std::vector<const Asset*>& assets,
                                              const Overrides& overrides, bool compressed,
                                              const std::vector<std::string>& kept) {
  std::vector<std::string> names;
  for (const Asset* asset : assets) names.push_back(asset->name);
  BuildSettings settings;
  settings.jobs = jobs_;
  settings.quiet = quiet_;
  Pipeline there = pipeline_at(name, overrides, compressed, kept);
  int status = kiln::build(there, select_assets(there, names), settings);
  // Many charts, or thin ones, have no room in the atlas of most pilots.
  while (status != 0 && enlarge_missing_atlases(there, names)) {
    there = pipeline_at(name, overrides, compressed, kept);
    status = kiln::build(there, select_assets(there, names), settings);
  }
  if (status != 0)
    throw BadInput(pipeline_.file.string(), fmt::format("pilots that end with status {}", status),
                   "assets that can be built", "mend what the stage has said");
  std::vector<PilotBuild> builds;
  for (const std::string& asset : names) {
    builds.push_back(read_build(there.output / asset, compressed ? "compress" : "bake"));
    for (const auto& [stage, seconds] : builds.back().cpu_seconds) cpu_seconds_ += seconds;
    cpu_seconds_ += record_of(there.output / asset, "report").at("cpu_seconds").get<double>();
  }
  return builds;
}

std::map<std::string, Pilot> PilotBuilds::build(const std::vector<const Asset*>& assets,
                                                const std::vector<std::string>& kept) {
  const std::vector<PilotBuild> coarse = build_at("coarse", assets, coarse_settings, false, kept),
                                fine = build_at("fine", assets, fine_settings, false, kept);
  std::map<std::string, Pilot> pilots;
  for (std::size_t k = 0; k < assets.size(); ++k) {
    Pilot& pilot = pilots[assets[k]->name];
    pilot.coarse = coarse[k];
    pilot.fine = fine[k];
    pilot.has_bounces = has_bounces(*assets[k]);
    pilot.input_triangles =
        record_of(folder_ / "fine" / assets[k]->name, "simplify").at("input_triangles").get<double>();
    if (is_moot(*assets[k], "simplify.faces")) {
      pilot.has_own_low = true;
      pilot.input_triangles = std::numeric_limits<double>::infinity();  // it never becomes the high mesh
    }
    pilot.must_be_vertices = bakes_vertices(assets[k]->settings);
    pilot.may_be_vertices = !pilot.coarse.at_vertices.empty() && !pilot.fine.at_vertices.empty() &&
                            allows(*assets[k], "bake.per-vertex", "true");
    pilot.may_be_unshadowed =
        !pilot.has_bounces && !pilot.fine.unshadowed.empty() && allows(*assets[k], "bake.shadows", "none");
    pilot.must_bounce = !effective_setting(assets[k]->settings, "bake", "spectrum").get<std::string>().empty();
    if (!pilot.has_bounces || pilot.must_bounce) continue;
    Overrides bare = coarse_settings;
    bare.emplace_back("bake.bounces", "0");
    bare.emplace_back("report.error-bounces", std::to_string(bounces_of(assets[k]->name)));
    pilot.without_bounces = build_at("bare", {assets[k]}, bare, false, kept).front();
  }
  return pilots;
}

int PilotBuilds::bounces_of(const std::string& asset) const {
  return record_of(folder_ / "fine" / asset, "bake").at("bounces").at("count").get<int>();
}

PilotBuild PilotBuilds::build_compressed(const Asset& asset, int bands, double max_error,
                                         const std::vector<std::string>& kept) {
  Overrides settings = fine_settings;
  settings.emplace_back("bake.bands", std::to_string(bands));
  settings.emplace_back("compress.max-error", fmt::format("{:.4g}", max_error));
  return build_at("compressed", {&asset}, settings, true, kept).front();
}

}  // namespace kiln
