// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <string_view>

#include "base/html.h"
#include "base/json.h"
#include "sh/light_spec.h"

namespace kiln {

namespace {

enum class Unit { plain, share, seconds, bytes, degrees };

struct Known {
  std::string_view key, label;
  Unit unit;
  Better better = Better::neither;
};

constexpr Known known_metrics[] = {
    {"seconds", "time", Unit::seconds, Better::lower},
    {"peak_memory_bytes", "peak memory", Unit::bytes, Better::lower},
    {"hausdorff", "Hausdorff distance, of diagonal", Unit::share, Better::lower},
    {"rms", "RMS distance, of diagonal", Unit::share, Better::lower},
    {"hausdorff_distance", "Hausdorff distance, object units", Unit::plain, Better::lower},
    {"utilisation", "utilisation", Unit::share, Better::higher},
    {"stretch_l2", "stretch L²", Unit::plain, Better::lower},
    {"stretch_linf", "stretch L∞", Unit::plain, Better::lower},
    {"texels_per_unit", "texels per unit length", Unit::plain},
    {"density_min", "texels per unit length, least of a chart", Unit::plain},
    {"density_max", "texels per unit length, most of a chart", Unit::plain},
    {"density_order", "power of spacing that transfer's error follows", Unit::plain},
    {"seam_length_relative", "seam length, of √area", Unit::plain, Better::lower},
    {"visible_seam_length_relative", "seam length seen from outside, of √area", Unit::plain, Better::lower},
    {"kept", "uvs kept", Unit::plain},
    {"lscm_charts", "charts by LSCM", Unit::plain},
    {"arap_charts", "charts by ARAP", Unit::plain},
    {"mean_value_charts", "charts by mean value", Unit::plain},
    {"found_by_ray_outwards", "found by ray outwards", Unit::share},
    {"found_by_ray_inwards", "found by ray inwards", Unit::share},
    {"found_by_nearest_point", "found by nearest point", Unit::share, Better::lower},
    {"disagreeing", "normals disagreeing", Unit::share, Better::lower},
    {"buried_texels", "texels buried in another part", Unit::plain, Better::lower},
    {"moved_texels", "texels moved to a place that is not buried", Unit::plain},
    {"cage_distance", "cage distance, object units", Unit::plain},
    {"mean_distance", "mean distance, object units", Unit::plain},
    {"largest_distance", "largest distance, object units", Unit::plain},
    {"normal_deviation_degrees_mean", "normal deviation, mean", Unit::degrees, Better::lower},
    {"normal_deviation_degrees_largest", "normal deviation, largest", Unit::degrees, Better::lower},
    {"quantisation_degrees_largest", "quantisation, largest", Unit::degrees, Better::lower},
    {"map_error_degrees_mean", "error of the map over the high mesh, mean", Unit::degrees, Better::lower},
    {"map_error_degrees_p95", "error of the map over the high mesh, 95 %", Unit::degrees, Better::lower},
    {"map_error_degrees_max", "error of the map over the high mesh, largest", Unit::degrees, Better::lower},
    {"seam_mismatch_degrees_mean_before", "seam mismatch as matched, mean", Unit::degrees},
    {"seam_mismatch_degrees_max_before", "seam mismatch as matched, largest", Unit::degrees},
    {"seam_mismatch_degrees_mean", "seam mismatch, mean", Unit::degrees, Better::lower},
    {"seam_mismatch_degrees_max", "seam mismatch, largest", Unit::degrees, Better::lower},
    {"seam_change_degrees_rms", "change of texels at seams, RMS", Unit::degrees},
    {"measuring_seconds", "time of measuring", Unit::seconds, Better::lower},
    {"seam_mismatch_mean_before", "mismatch as baked, mean, of the RMS vector", Unit::share},
    {"seam_mismatch_max_before", "mismatch as baked, largest, of the RMS vector", Unit::share},
    {"seam_mismatch_mean", "mismatch, mean, of the RMS vector", Unit::share, Better::lower},
    {"seam_mismatch_max", "mismatch, largest, of the RMS vector", Unit::share, Better::lower},
    {"change", "change of texels, relative L²", Unit::share},
    {"texels", "covered texels", Unit::plain},
    {"quantisation_error", "quantisation error, relative L²", Unit::share, Better::lower},
    {"backend_difference", "difference from the other backend, relative L²", Unit::share, Better::lower},
    {"backend_difference_uncertainty", "± of that, 95 % confidence", Unit::share},
    {"backend_texels", "texels that both backends baked", Unit::plain},
    {"integration_error_uncertainty", "± of that, 95 % confidence", Unit::share},
    {"error_uncertainty", "± of that, 95 % confidence", Unit::share},
    {"relighting_error_uncertainty", "± of that, 95 % confidence", Unit::share},
    {"integration_error", "integration error, relative L²", Unit::share, Better::lower},
    {"error", "error of the stored planes, relative L²", Unit::share, Better::lower},
    {"relighting_error", "expected relighting error", Unit::share, Better::lower},
    {"relative_l2", "difference, relative L², worst light", Unit::share, Better::lower},
    {"relative_l2_uncertainty", "more than that at most, 95 % confidence", Unit::share},
    {"root_mean_square", "difference, RMS radiance, worst light", Unit::plain, Better::lower},
    {"compressed_relative_l2", "difference by compression, relative L², worst light", Unit::share, Better::lower},
    {"compress.error", "expected relighting error against the baked planes", Unit::share, Better::lower},
    {"target_error", "error asked for, expected relighting error", Unit::share},
    {"bytes_in", "bytes that ship of the baked folder", Unit::plain, Better::lower},
    {"bytes_out", "bytes that ship", Unit::bytes, Better::lower},
    {"gpu_bytes", "bytes on the GPU", Unit::bytes, Better::lower},
    {"compressed_gpu_bytes", "bytes on the GPU, compressed", Unit::bytes, Better::lower},
    {"bytes_per_texel_in", "bytes of coefficients per covered texel, baked", Unit::plain, Better::lower},
    {"bytes_per_texel_out", "bytes of coefficients per covered texel", Unit::plain, Better::lower},
    {"lookups_in", "texture lookups, baked", Unit::plain, Better::lower},
    {"lookups_out", "texture lookups", Unit::plain, Better::lower},
    {"open_share", "share of the sky that points see, mean", Unit::share},
    {"invalid", "points inside of something solid", Unit::plain, Better::lower},
    {"last_bounce_share", "light that the last bounce added, relative L²", Unit::share, Better::lower},
    {"surface_points", "points of the surface that light bounces at", Unit::plain},
    {"border_share", "texels at borders of clusters", Unit::share, Better::lower},
    {"overlapping_texels", "overlapping texels", Unit::plain, Better::lower},
    {"degenerate_triangles", "degenerate triangles", Unit::plain, Better::lower},
    {"flipped_triangles", "flipped triangles", Unit::plain, Better::lower},
    {"texel_error", "texel error", Unit::share, Better::lower},
    {"border_jump", "border jump", Unit::plain, Better::lower},
    {"texel_directions_per_second", "texel directions per second", Unit::plain, Better::higher},
    {"report.error.total", "expected relighting error as seen", Unit::share, Better::lower},
    {"report.error.root_sum_of_causes", "root of the sum of its causes' squares", Unit::share},
    {"report.error.causes.geometry", "of it: geometry", Unit::share, Better::lower},
    {"report.error.causes.texels", "of it: texels", Unit::share, Better::lower},
    {"report.error.causes.bands", "of it: bands", Unit::share, Better::lower},
    {"report.error.causes.directions", "of it: directions", Unit::share, Better::lower},
    {"report.error.causes.bits", "of it: bits", Unit::share, Better::lower},
    {"report.error.causes.visibility", "of it: visibility", Unit::share, Better::lower},
    {"report.error.causes.shadows", "of it: shadows left out", Unit::share, Better::lower},
    {"report.error.causes.albedo", "of it: albedo", Unit::share, Better::lower},
    {"report.error.causes.receivers", "of it: receivers on the low mesh", Unit::share, Better::lower},
    {"report.error.causes.subsurface", "of it: light beneath the surface", Unit::share, Better::lower},
    {"report.error.causes.vertices", "of it: vertices", Unit::share, Better::lower},
    {"report.error.causes.bounces", "of it: bounces and visibility", Unit::share, Better::lower},
    {"report.error.causes.seams", "of it: seams", Unit::share, Better::lower},
    {"report.error.causes.compression", "of it: compression", Unit::share, Better::lower},
    {"uv_deviation", "how far textures slide, largest, of diagonal", Unit::share, Better::lower},
    {"uv_deviation_rms", "how far textures slide, RMS, of diagonal", Unit::share, Better::lower},
    {"popping", "change of a pixel's radiance from level to level, largest", Unit::plain, Better::lower},
    {"popping_inside", "the same inside both silhouettes, largest", Unit::plain, Better::lower},
    {"texel_displacement_mean", "texels' distance from where they were made for, mean, object units", Unit::plain,
     Better::lower},
    {"texel_displacement_max", "texels' distance from where they were made for, largest, object units", Unit::plain,
     Better::lower},
    {"rms_distance", "RMS distance, object units", Unit::plain, Better::lower},
    {"high_hausdorff_distance", "Hausdorff distance to the high mesh, object units", Unit::plain, Better::lower},
    {"high_rms_distance", "RMS distance to the high mesh, object units", Unit::plain, Better::lower},
    {"lod.error", "error of the levels, object units", Unit::plain, Better::lower},
    {"lod.triangles", "triangles of the coarsest level", Unit::plain},
    {"missed_goals", "levels that are finer than asked for", Unit::plain, Better::lower},
    {"overhanging_texels", "texels that levels cover beside their charts", Unit::plain, Better::lower},
    {"deserted_texels", "texels that levels no longer cover", Unit::plain},
    {"silhouette_difference", "silhouette difference", Unit::share, Better::lower},
};

std::string last_part(const std::string& key) { return key.substr(key.rfind('.') + 1); }

/// Finds a key with its stage, else by its last part. metrics.json has the report's error without its stage, too.
const Known* find_known(const std::string& key) {
  for (const std::string& name : {key, "report." + key, last_part(key)})
    for (const Known& known : known_metrics)
      if (known.key == name) return &known;
  return nullptr;
}

Unit unit_of(const std::string& key) {
  if (const Known* known = find_known(key)) return known->unit;
  if (key.ends_with("_seconds")) return Unit::seconds;
  if (key.ends_with("_bytes")) return Unit::bytes;
  if (key.ends_with("_degrees")) return Unit::degrees;
  if (key.ends_with("_error")) return Unit::share;
  return Unit::plain;
}

}  // namespace

std::string grouped(long long value) {
  std::string text = std::to_string(std::abs(value));
  for (int at = static_cast<int>(text.size()) - 3; at > 0; at -= 3) text.insert(at, "\u202f");
  return (value < 0 ? "−" : "") + text;
}

std::string rounded(double value, int digits) {
  if (!std::isfinite(value)) return "not finite";
  const double magnitude = std::abs(value);
  std::string text;
  if (magnitude >= std::pow(10.0, digits)) {
    text = grouped(std::llround(magnitude));
  } else if (magnitude == 0) {
    text = "0";
  } else if (magnitude < 1e-4) {
    text = fmt::format("{:.{}e}", magnitude, digits - 1);
  } else {
    const int decimals = std::max(0, digits - 1 - static_cast<int>(std::floor(std::log10(magnitude))));
    text = fmt::format("{:.{}f}", magnitude, decimals);
  }
  return (value < 0 ? "−" : "") + text;
}

Better better_direction(const std::string& key) {
  if (const Known* known = find_known(key)) return known->better;
  return unit_of(key) == Unit::seconds || key.ends_with("_error") ? Better::lower : Better::neither;
}

bool is_machine_cost(const std::string& key) {
  return unit_of(key) == Unit::seconds || key.ends_with("peak_memory_bytes") || key.ends_with("_per_second");
}

std::string metric_label(const std::string& key) {
  if (const Known* known = find_known(key)) return std::string(known->label);
  std::string text = last_part(key);
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string metric_value(const std::string& key, const Json& value) {
  if (value.is_null()) return "not finite";
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_string()) return html_escaped(value.get<std::string>());
  if (!value.is_number()) return html_escaped(value.dump());
  const double number = value.get<double>();
  switch (unit_of(key)) {
    case Unit::share:
      return rounded(100 * number, 3) + "&#8239;%";
    case Unit::seconds:
      return (number < 10 ? fmt::format("{:.2f}", number) : fmt::format("{:.1f}", number)) + "&#8239;s";
    case Unit::bytes:
      return rounded(number / (1024 * 1024), 3) + "&#8239;MiB";
    case Unit::degrees:
      return rounded(number, 3) + "°";
    case Unit::plain:
      break;
  }
  return value.is_number_integer() ? grouped(value.get<long long>()) : rounded(number, 4);
}

std::string light_label(const std::string& light) {
  const LightSpec spec = parse_light_spec(light);
  const auto color = [&] {
    const auto& [r, g, b] = spec.color;
    return r == g && g == b ? fmt::format("{:g}", r) : fmt::format("{:g}, {:g}, {:g}", r, g, b);
  };
  if (spec.kind == LightSpec::Kind::ambient) return "Ambient, radiance " + color();
  const auto degrees = [](double angle) { return fmt::format("{}{:g}°", angle < 0 ? "−" : "", std::abs(angle)); };
  std::string text =
      "Directional, azimuth " + degrees(spec.azimuth_degrees) + ", elevation " + degrees(spec.elevation_degrees);
  if (spec.color != std::array<float, 3>{1, 1, 1}) text += ", radiance " + color();
  return text;
}

}  // namespace kiln
