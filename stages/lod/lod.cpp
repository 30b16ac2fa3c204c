// SPDX-License-Identifier: GPL-3.0-or-later
#include "lod/lod.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "asset/format.h"
#include "base/errors.h"
#include "base/json.h"
#include "base/stopwatch.h"
#include "mesh/mesh_distance.h"

namespace kiln {

namespace {

/// Returns the texels that a chart may hang over where they lie nearer to it than to any other: with the lookup's half
/// texel as many as the gutter has, which continue its chart.
double farthest_overhang(double overhang) { return overhang > 0 ? 2 * overhang + 0.5 : 0; }

struct Goals {
  std::vector<LevelGoal> goals;
  std::vector<double> asked;  ///< as the settings have them
};

Goals goals_of(const LodInput& input, const LodSettings& settings, double radius) {
  Goals all;
  all.asked = settings.pixel_errors();
  for (const double pixels : all.asked) all.goals.push_back({0, length_of_pixels(pixels, radius, settings.view)});
  if (!all.asked.empty()) return all;
  all.asked = settings.shares();
  const auto whole = static_cast<double>(input.atlas.triangles.size());
  for (const double share : all.asked) all.goals.push_back({static_cast<int>(std::lround(share * whole)), 0});
  return all;
}

/// Makes the levels. Those of an error are the coarsest found that keep to it where they are measured: the collapse
/// goes by samples, between which there may be more, so it goes again to smaller errors, and halves what it does not
/// know.
std::vector<Level> chain_within(const LodInput& input, const std::vector<LevelGoal>& goals,
                                const TexelDisplacementMeter& meter, const ProgressFunction& progress) {
  const LevelLimits limits{input.size, input.overhang_texels, farthest_overhang(input.overhang_texels)};
  if (goals.front().error == 0) return make_level_chain(input.atlas, goals, limits, progress);
  const double diagonal = bounding_box(input.atlas).diagonal();
  constexpr std::size_t attempts = 6;
  constexpr double first_step = 0.7, margin = 0.99;  // the file rounds a little
  std::vector<LevelGoal> tried = goals;
  std::vector<double> kept(goals.size(), 0), broken(goals.size(), 0);
  std::vector<Level> best(goals.size());
  for (std::size_t attempt = 0; attempt < attempts; ++attempt) {
    std::vector<Level> levels = make_level_chain(input.atlas, tried, limits, step_of(progress, attempt, attempts));
    for (std::size_t k = 0; k < goals.size(); ++k) {
      const TriangleMesh& mesh = levels[k].mesh;
      const double error = std::max(meter.measure(mesh).largest, mesh_distance(input.atlas, mesh).hausdorff * diagonal);
      const bool keeps = error <= margin * goals[k].error;
      const bool is_best = kept[k] == 0 || (keeps && mesh.triangles.size() <= best[k].mesh.triangles.size());
      (keeps ? kept[k] : broken[k]) = tried[k].error;
      if (is_best) best[k] = std::move(levels[k]);  // until one keeps to it, the last and least
      if (broken[k] > 0) tried[k].error = kept[k] > 0 ? (kept[k] + broken[k]) / 2 : first_step * broken[k];
      if (k > 0) tried[k].error = std::max(tried[k].error, tried[k - 1].error);
    }
    if (std::all_of(broken.begin(), broken.end(), [](double error) { return error == 0; })) break;
  }
  return best;
}

/// Writes a level and measures what the file holds.
WrittenLevel write_level(OutputSet& outputs, const std::string& name, const TriangleMesh& mesh, const LodInput& input,
                         const TexelDisplacementMeter& meter) {
  const std::filesystem::path file = outputs.add(name);
  DracoQuantisation quantisation = input.quantisation;
  quantisation.texture_uv_bits = sufficient_uv_bits(mesh.texture_uvs);
  save_draco(file, mesh, quantisation);
  const TriangleMesh read = load_atlas(file);
  const double unit = input.atlas.frame.unit();
  WrittenLevel level;
  level.file = name;
  level.triangles = read.triangles.size();
  level.vertices = read.positions.size();
  level.texels = meter.measure(read);
  level.texels.mean *= unit;
  level.texels.largest *= unit;
  const auto measure = [&](const TriangleMesh& other, double& hausdorff, double& rms) {
    const MeshDistance distance = mesh_distance(other, read);
    const double diagonal = bounding_box(other).diagonal() * unit;
    hausdorff = distance.hausdorff * diagonal;
    rms = distance.rms * diagonal;
  };
  measure(input.atlas, level.hausdorff, level.rms);
  if (input.high != nullptr) measure(*input.high, level.high_hausdorff, level.high_rms);
  level.error = std::max(level.hausdorff, level.texels.largest);
  return level;
}

std::string why_no_fewer(const LodInput& input, std::size_t triangles, const std::string& asked) {
  return fmt::format(
      "{} triangles are left for the level of {}: no further collapse keeps seams, borders and their junctions, charts "
      "within {:g} texels of their outlines, and triangles from folding over; fewer charts, or a wider gutter of "
      "kiln-atlas, would allow more",
      triangles, asked, input.overhang_texels);
}

}  // namespace

LodInput lod_input(const TriangleMesh& atlas, const TriangleMesh* high, const LodSettings& settings,
                   const AssetHints& hints, const std::string& file) {
  LodInput input{atlas, high, settings.size, 0, {}, file};
  if (settings.size.width == 0) input.size = {hints.width, hints.height};
  if (input.size.width == 0)
    throw WrongUsage("size: found no atlas.json beside " + file + "; expected --size, the atlas's size in texels");
  input.overhang_texels = settings.overhang_texels.value_or(std::max(0.0, 0.5 * hints.gap_texels - 0.5));
  input.quantisation.position_bits = std::max(input.quantisation.position_bits, hints.position_bits);
  input.quantisation.uv_bits = std::max(input.quantisation.uv_bits, hints.uv_bits);
  return input;
}

LodResult make_levels(OutputSet& outputs, const LodInput& input, const LodSettings& settings,
                      const ProgressFunction& progress) {
  LodResult result;
  const Stopwatch whole;
  const double radius = 0.5 * bounding_box(input.atlas).diagonal();  // in units of the mesh
  result.radius = radius * input.atlas.frame.unit();

  // Collapse.
  const Goals goals = goals_of(input, settings, radius);
  const Stopwatch collapse;
  const TexelDisplacementMeter meter(input.atlas, input.size);
  const std::vector<Level> levels = chain_within(input, goals.goals, meter, part_of(progress, 0, 0.7));
  result.collapse_seconds = collapse.seconds();

  // Write, and measure what was written.
  std::size_t before = input.atlas.triangles.size();
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const bool by_pixels = goals.goals[k].error > 0;
    const std::string asked =
        by_pixels ? fmt::format("{:g} pixels", goals.asked[k]) : fmt::format("{:g} of the atlas mesh", goals.asked[k]);
    const std::size_t triangles = levels[k].mesh.triangles.size();
    if (!levels[k].reached_goal && !by_pixels) result.warnings.push_back(why_no_fewer(input, triangles, asked));
    if (triangles >= before) {
      result.warnings.push_back("the level of " + asked + " would be the one before it, and is left out");
      continue;
    }
    before = triangles;
    const std::string name = level_file(static_cast<int>(result.levels.size()) + 1);
    WrittenLevel level = write_level(outputs, name, levels[k].mesh, input, meter);
    level.goal = goals.asked[k];
    const double allowed = goals.goals[k].error * input.atlas.frame.unit();
    level.reached_goal = by_pixels ? level.error <= allowed : levels[k].reached_goal;
    if (by_pixels && !level.reached_goal)
      result.warnings.push_back(
          fmt::format("the level of {} has an error of {:.3g} of them", asked, goals.asked[k] * level.error / allowed));
    level.distance = switching_distance(level.error, result.radius, settings.switch_pixels, settings.view);
    if (!result.levels.empty()) level.distance = std::max(level.distance, result.levels.back().distance);
    result.levels.push_back(level);
    progress(0.7 + 0.3 * static_cast<double>(k + 1) / static_cast<double>(levels.size()));
  }
  if (result.levels.empty())
    throw BadInput(input.file, "has no collapse that keeps its seams and its atlas", "a mesh that can be coarser",
                   "leave out levels of detail for it");
  for (int k = static_cast<int>(result.levels.size()) + 1; k <= most_levels; ++k) outputs.remove_stale(level_file(k));
  result.seconds = whole.seconds();
  return result;
}

Json LodResult::to_json(const LodInput& input) const {
  Json list = Json::array();
  WrittenLevel worst;
  int missed = 0;
  for (const WrittenLevel& level : levels) {
    Json entry = {{key::mesh, level.file},
                  {key::triangles, level.triangles},
                  {key::error, level.error},
                  {key::distance, level.distance},
                  {"goal", level.goal},
                  {"reached_goal", level.reached_goal},
                  {"vertices", level.vertices},
                  {"hausdorff_distance", level.hausdorff},
                  {"rms_distance", level.rms},
                  {"texel_displacement_mean", level.texels.mean},
                  {"texel_displacement_max", level.texels.largest},
                  {"overhanging_texels", level.texels.overhanging},
                  {"overlapping_texels", level.texels.overlapping},
                  {"deserted_texels", level.texels.deserted}};
    if (input.high != nullptr) {
      entry["high_hausdorff_distance"] = level.high_hausdorff;
      entry["high_rms_distance"] = level.high_rms;
    }
    list.push_back(std::move(entry));
    missed += level.reached_goal ? 0 : 1;
    worst.error = std::max(worst.error, level.error);
    worst.hausdorff = std::max(worst.hausdorff, level.hausdorff);
    worst.rms = std::max(worst.rms, level.rms);
    worst.high_hausdorff = std::max(worst.high_hausdorff, level.high_hausdorff);
    worst.high_rms = std::max(worst.high_rms, level.high_rms);
    worst.texels.mean = std::max(worst.texels.mean, level.texels.mean);
    worst.texels.largest = std::max(worst.texels.largest, level.texels.largest);
    worst.texels.overhanging = std::max(worst.texels.overhanging, level.texels.overhanging);
    worst.texels.overlapping = std::max(worst.texels.overlapping, level.texels.overlapping);
    worst.texels.deserted = std::max(worst.texels.deserted, level.texels.deserted);
  }
  Json json = {{key::levels, std::move(list)},
               {"level_count", levels.size()},
               {"missed_goals", missed},
               {"atlas_triangles", input.atlas.triangles.size()},
               {"triangles", levels.back().triangles},
               {"vertices", levels.back().vertices},
               {"error", worst.error},
               {"distance", levels.back().distance},
               {"hausdorff_distance", worst.hausdorff},
               {"rms_distance", worst.rms},
               {"texel_displacement_mean", worst.texels.mean},
               {"texel_displacement_max", worst.texels.largest},
               {"overhanging_texels", worst.texels.overhanging},
               {"overlapping_texels", worst.texels.overlapping},
               {"deserted_texels", worst.texels.deserted},
               {"overhang_limit", input.overhang_texels},
               {"radius", radius},
               {"collapse_seconds", collapse_seconds}};
  if (input.high != nullptr) {
    json["high_hausdorff_distance"] = worst.high_hausdorff;
    json["high_rms_distance"] = worst.high_rms;
  }
  return json;
}

}  // namespace kiln
