// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/plan/asset_model.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kiln {

namespace {

/// Bits of the planes of every pilot.
constexpr int pilot_bits = 8;

/// CPU seconds for each texel of a plane: its sums, gutters, seams, PNG. What 8 bands of the bunny took more than 5,
/// 512 x 512 texels.
constexpr double seconds_per_plane_texel = 5e-7;

/// Least exponent of a bake's seconds beyond the pilots.
constexpr double least_bake_exponent = 0.35;

/// What packing by the 16 turns of a chart that builds try takes of kiln-atlas, over that by the pilots' 4: 1.37 and
/// 1.39 on the bunny of 500 and 2,000 triangles.
constexpr double atlas_over_pilot = 1.4;

/// Steepest exponent by which the square of lookups between vertices falls with the triangles: it was 0.8 to 0.95 on
/// the bunny from 500 to 2,000 and to 8,000 triangles.
constexpr double steepest_of_vertices = 1.2;

/// Directions as which a bake without any counts: what is left, reading and writing, is no dearer.
constexpr int fewest_directions = 64;

double sum_of_first(const std::vector<double>& values, int count) {
  const std::size_t n = std::min(values.size(), static_cast<std::size_t>(count));
  return std::accumulate(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(n), 0.0);
}

/// Returns what squares by band are of the transfer seen in an asset of so many bands.
double share_of(const std::vector<double>& squares, const PilotBuild& build, int bands) {
  return std::max(0.0, sum_of_first(squares, bands) / sum_of_first(build.seen, bands));
}

/// Returns the square of a cause's error in an asset of so many bands; 0 where the build has no such cause.
double square_of(const PilotBuild& build, const std::string& cause, int bands) {
  const auto found = build.squares.find(cause);
  return found == build.squares.end() ? 0 : share_of(found->second, build, bands);
}

/// Returns the value at `x` of the line through two points, which neither falls nor begins below 0.
double rising_line(double x1, double y1, double x2, double y2, double x) {
  if (x2 <= x1) return y2;
  const double slope = std::max(0.0, (y2 - y1) / (x2 - x1));
  return std::max(0.0, y2 - slope * x2) + slope * x;
}

double stage_seconds(const PilotBuild& build, const std::string& stage) {
  const auto found = build.cpu_seconds.find(stage);
  return found == build.cpu_seconds.end() ? 0 : found->second;
}

}  // namespace

double error_of(const PilotBuild& build, const std::string& cause, int bands) {
  return std::sqrt(square_of(build, cause, bands));
}

double power_law(double x1, double y1, double x2, double y2, double x, double least, double most) {
  if (!(x1 > 0 && x2 > 0 && y1 > 0 && y2 > 0) || x1 == x2) return y2;
  const double measured = std::min(most, std::log(y2 / y1) / std::log(x2 / x1));
  // Between the points and below them what was measured counts; beyond the second, no more than is known to last.
  const double exponent = x > x2 ? std::max(least, measured) : measured;
  return y2 * std::pow(x / x2, exponent);
}

AssetModel::AssetModel(Pilot pilot) : pilot_(std::move(pilot)) {}

double AssetModel::texels(double size) const {
  // Gutters take a strip along every chart, whose share of the side falls with the size.
  const auto side = [](const PilotBuild& build) { return std::sqrt(build.texels); };
  const double slope = (side(pilot_.fine) - side(pilot_.coarse)) / (pilot_.fine.size - pilot_.coarse.size);
  const double covered = side(pilot_.fine) + std::clamp(slope, 0.5, 1.0) * (size - pilot_.fine.size);
  return std::max(1.0, covered * covered);
}

Prediction AssetModel::predict(const Choice& choice) const {
  const PilotBuild &coarse = pilot_.coarse, &fine = pilot_.fine;
  const int bands = choice.bands;
  std::map<std::string, double> squares;
  const auto follow = [&](const char* cause, double PilotBuild::*variable, double x, double steepest) {
    squares[cause] = power_law(coarse.*variable, square_of(coarse, cause, bands), fine.*variable,
                               square_of(fine, cause, bands), x, -steepest, 0);
  };
  // Exponents of squares, at most: of a transfer that jumps, a lookup's error falls with the texels' distance for the
  // share of points near a jump, as does a quadrature's with the power 3/4 of its directions [Beck 1984]; seams
  // are points at borders, whose share falls likewise, but never as fast as where every texel is at one.
  follow("geometry", &PilotBuild::triangles, choice.triangles, 1.5);
  if (fine.squares.contains("receivers")) follow("receivers", &PilotBuild::triangles, choice.triangles, 1.5);
  if (choice.triangles >= pilot_.input_triangles) squares["geometry"] = 0;
  if (choice.per_vertex) {
    squares["vertices"] =
        power_law(coarse.triangles, share_of(coarse.at_vertices, coarse, bands), fine.triangles,
                  share_of(fine.at_vertices, fine, bands), choice.triangles, -steepest_of_vertices, 0);
  } else {
    const double covered = texels(choice.size);
    follow("texels", &PilotBuild::texels, covered, 1.5);
    if (square_of(fine, "albedo", bands) > 0) follow("albedo", &PilotBuild::texels, covered, 1.5);
    follow("seams", &PilotBuild::texels, covered, 1);
  }
  if (choice.directions > 0) follow("directions", &PilotBuild::directions, choice.directions, 1.5);
  squares["bits"] = square_of(fine, "bits", bands) * std::pow(0.25, choice.bits - pilot_bits);
  if (choice.directions == 0)
    squares["shadows"] = share_of(fine.unshadowed, fine, bands);
  else if (pilot_.has_bounces && choice.bounces)
    // Bounced light is gathered over the bake's directions. Its error is averaged over the four texels of a lookup,
    // which keeps 4/9 of its square, until texels are finer than its grain.
    squares["bounces"] =
        9.0 / 4 * square_of(fine, "bounces", bands) * std::pow(fine.directions / choice.directions, 1.5);
  else if (pilot_.has_bounces)
    squares["bounces"] = square_of(pilot_.without_bounces, "bounces", bands);
  else
    squares["visibility"] = square_of(fine, "visibility", bands);
  const double kept = sum_of_first(fine.seen, bands);
  squares["bands"] = (sum_of_first(fine.seen, static_cast<int>(fine.seen.size())) - kept) / kept;
  if (choice.compression > 0) {
    // kiln-compress keeps its error by the measured prior; the pilot says what that is in the light expected here.
    squares["compression"] = choice.compression * choice.compression;
    if (pilot_.is_compressed) squares["compression"] = square_of(pilot_.compressed, "compression", bands);
  }
  Prediction prediction;
  double sum = 0;
  for (const auto& [cause, square] : squares) {
    prediction.causes[cause] = std::sqrt(square);
    sum += square;
  }
  // Causes that are related add up to less, or more: take the pilot's own ratio.
  const double ratio = fine.root_sum > 0 ? std::clamp(fine.total / fine.root_sum, 0.85, 1.1) : 1;
  prediction.error = ratio * std::sqrt(sum);
  prediction.uncertainty = prediction.error * fine.uncertainty / fine.total;
  prediction.cpu_seconds = cpu_seconds(choice);
  prediction.bytes = bytes(choice);
  return prediction;
}

double AssetModel::vertices(const Choice& choice) const {
  return rising_line(pilot_.coarse.triangles, pilot_.coarse.vertices, pilot_.fine.triangles, pilot_.fine.vertices,
                     choice.triangles);
}

double AssetModel::receivers(const Choice& choice) const {
  return choice.per_vertex ? vertices(choice) : texels(choice.size);
}

double AssetModel::bake_seconds(const Choice& choice) const {
  const PilotBuild &coarse = pilot_.coarse, &fine = pilot_.fine;
  // Neighbouring rays share their work, the more the denser texels and directions are: the seconds of a bake, without
  // those of its planes, follow a power of the pairs of a texel and a direction well below 1.
  const auto planes = [](const PilotBuild& build) {
    return seconds_per_plane_texel * build.texels * build.bands * build.bands;
  };
  const auto pairs = [](const PilotBuild& build) { return (build.texels + build.cache_points) * build.directions; };
  // More work is never cheaper: where the pilots say so, what they measured is reading and writing.
  const double least = stage_seconds(coarse, "bake") - planes(coarse),
               most = std::max(least, stage_seconds(fine, "bake") - planes(fine));
  const double work = (receivers(choice) + fine.cache_points) * std::max(choice.directions, fewest_directions);
  const double bake = power_law(pairs(coarse), least, pairs(fine), most, work, least_bake_exponent, 1) +
                      seconds_per_plane_texel * receivers(choice) * choice.bands * choice.bands;
  if (!pilot_.has_bounces || choice.bounces || stage_seconds(coarse, "bake") <= 0) return bake;
  // Without bounces a bake is as much cheaper as in the pilot.
  return bake * std::min(1.0, stage_seconds(pilot_.without_bounces, "bake") / stage_seconds(coarse, "bake"));
}

double AssetModel::cpu_seconds(const Choice& choice) const {
  const PilotBuild &coarse = pilot_.coarse, &fine = pilot_.fine;
  const auto line = [&](const char* stage, double work_coarse, double work_fine, double work) {
    return rising_line(work_coarse, stage_seconds(coarse, stage), work_fine, stage_seconds(fine, stage), work);
  };
  double seconds = stage_seconds(fine, "simplify") + bake_seconds(choice);
  if (choice.per_vertex) return seconds;
  const double covered = texels(choice.size);
  seconds += atlas_over_pilot * line("atlas", coarse.triangles, fine.triangles, choice.triangles);
  seconds += line("normals", coarse.texels, fine.texels, covered);
  if (choice.compression > 0 && pilot_.is_compressed)
    seconds += stage_seconds(pilot_.compressed, "compress") * covered / pilot_.compressed.texels;
  return seconds;
}

double AssetModel::bytes(const Choice& choice) const {
  const PilotBuild &coarse = pilot_.coarse, &fine = pilot_.fine;
  const double mesh =
      rising_line(coarse.triangles, coarse.mesh_bytes, fine.triangles, fine.mesh_bytes, choice.triangles);
  // Coefficients of vertices take their bits: Draco finds little in them. The bunny's files, mesh included, have 102 to
  // 104 % of that from 1,000 vertices on, 120 % at 250.
  if (choice.per_vertex) return mesh + vertices(choice) * choice.bands * choice.bands * choice.bits / 8;
  const double covered = texels(choice.size);
  // Larger pictures are smoother, so their bytes grow less than their texels.
  const auto at = [&](double PilotBuild::*bytes, double texels) {
    return power_law(coarse.texels, coarse.*bytes, fine.texels, fine.*bytes, texels, 0.5, 1);
  };
  const double maps = at(&PilotBuild::map_bytes, covered), planes = at(&PilotBuild::plane_bytes, covered);
  if (choice.compression > 0 && pilot_.is_compressed) {
    const double growth = planes / at(&PilotBuild::plane_bytes, pilot_.compressed.texels);
    return mesh + maps + pilot_.compressed.plane_bytes * growth;
  }
  const double coefficients = static_cast<double>(choice.bands * choice.bands) / (fine.bands * fine.bands);
  return mesh + maps + planes * coefficients * choice.bits / pilot_bits;
}

}  // namespace kiln
