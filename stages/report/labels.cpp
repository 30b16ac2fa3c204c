// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <string_view>

#include "base/json.h"
#include "sh/light_spec.h"

namespace kiln {

namespace {

enum class Unit { plain, share, seconds, bytes, degrees };

struct Known {
  std::string_view key, label;
  Unit unit;
};

constexpr Known known_metrics[] = {
    {"seconds", "time", Unit::seconds},
    {"peak_memory_bytes", "peak memory", Unit::bytes},
    {"hausdorff", "Hausdorff distance, of diagonal", Unit::share},
    {"rms", "RMS distance, of diagonal", Unit::share},
    {"hausdorff_distance", "Hausdorff distance, object units", Unit::plain},
    {"utilisation", "utilisation", Unit::share},
    {"stretch_l2", "stretch L²", Unit::plain},
    {"stretch_linf", "stretch L∞", Unit::plain},
    {"texels_per_unit", "texels per unit length", Unit::plain},
    {"density_min", "texels per unit length, least of a chart", Unit::plain},
    {"density_max", "texels per unit length, most of a chart", Unit::plain},
    {"density_order", "power of spacing that transfer's error follows", Unit::plain},
    {"seam_length_relative", "seam length, of √area", Unit::plain},
    {"visible_seam_length_relative", "seam length seen from outside, of √area", Unit::plain},
    {"kept", "uvs kept", Unit::plain},
    {"lscm_charts", "charts by LSCM", Unit::plain},
    {"arap_charts", "charts by ARAP", Unit::plain},
    {"mean_value_charts", "charts by mean value", Unit::plain},
    {"found_by_ray_outwards", "found by ray outwards", Unit::share},
    {"found_by_ray_inwards", "found by ray inwards", Unit::share},
    {"found_by_nearest_point", "found by nearest point", Unit::share},
    {"disagreeing", "normals disagreeing", Unit::share},
    {"buried_texels", "texels buried in another part", Unit::plain},
    {"moved_texels", "texels moved to a place that is not buried", Unit::plain},
    {"cage_distance", "cage distance, object units", Unit::plain},
    {"mean_distance", "mean distance, object units", Unit::plain},
    {"largest_distance", "largest distance, object units", Unit::plain},
    {"normal_deviation_degrees_mean", "normal deviation, mean", Unit::degrees},
    {"normal_deviation_degrees_largest", "normal deviation, largest", Unit::degrees},
    {"quantisation_degrees_largest", "quantisation, largest", Unit::degrees},
    {"map_error_degrees_mean", "error of the map over the high mesh, mean", Unit::degrees},
    {"map_error_degrees_p95", "error of the map over the high mesh, 95 %", Unit::degrees},
    {"map_error_degrees_max", "error of the map over the high mesh, largest", Unit::degrees},
    {"seam_mismatch_degrees_mean_before", "seam mismatch as matched, mean", Unit::degrees},
    {"seam_mismatch_degrees_max_before", "seam mismatch as matched, largest", Unit::degrees},
    {"seam_mismatch_degrees_mean", "seam mismatch, mean", Unit::degrees},
    {"seam_mismatch_degrees_max", "seam mismatch, largest", Unit::degrees},
    {"seam_change_degrees_rms", "change of texels at seams, RMS", Unit::degrees},
    {"measuring_seconds", "time of measuring", Unit::seconds},
    {"seam_mismatch_mean_before", "mismatch as baked, mean, of the RMS vector", Unit::share},
    {"seam_mismatch_max_before", "mismatch as baked, largest, of the RMS vector", Unit::share},
    {"seam_mismatch_mean", "mismatch, mean, of the RMS vector", Unit::share},
    {"seam_mismatch_max", "mismatch, largest, of the RMS vector", Unit::share},
    {"change", "change of texels, relative L²", Unit::share},
    {"texels", "covered texels", Unit::plain},
    {"quantisation_error", "quantisation error, relative L²", Unit::share},
    {"backend_difference", "difference from the other backend, relative L²", Unit::share},
    {"backend_difference_uncertainty", "± of that, 95 % confidence", Unit::share},
    {"backend_texels", "texels that both backends baked", Unit::plain},
    {"integration_error_uncertainty", "± of that, 95 % confidence", Unit::share},
    {"error_uncertainty", "± of that, 95 % confidence", Unit::share},
    {"relighting_error_uncertainty", "± of that, 95 % confidence", Unit::share},
    {"integration_error", "integration error, relative L²", Unit::share},
    {"error", "error of the stored planes, relative L²", Unit::share},
    {"relighting_error", "expected relighting error", Unit::share},
    {"relative_l2", "difference, relative L², worst light", Unit::share},
    {"root_mean_square", "difference, RMS radiance, worst light", Unit::plain},
    {"compressed_relative_l2", "difference by compression, relative L², worst light", Unit::share},
    {"compress.error", "expected relighting error against the baked planes", Unit::share},
    {"target_error", "error asked for, expected relighting error", Unit::share},
    {"bytes_in", "bytes of the baked planes", Unit::plain},
    {"bytes_out", "bytes", Unit::plain},
    {"bytes_per_texel_in", "bytes per covered texel, baked", Unit::plain},
    {"bytes_per_texel_out", "bytes per covered texel", Unit::plain},
    {"lookups_in", "texture lookups, baked", Unit::plain},
    {"lookups_out", "texture lookups", Unit::plain},
    {"open_share", "share of the sky that points see, mean", Unit::share},
    {"invalid", "points inside of something solid", Unit::plain},
    {"last_bounce_share", "light that the last bounce added, relative L²", Unit::share},
    {"surface_points", "points of the surface that light bounces at", Unit::plain},
    {"border_share", "texels at borders of clusters", Unit::share},
    {"silhouette_difference", "silhouette difference", Unit::share},
};

std::string last_part(const std::string& key) { return key.substr(key.rfind('.') + 1); }

/// Finds a key with its stage, else by its last part.
const Known* find_known(const std::string& key) {
  for (const std::string& name : {key, last_part(key)})
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

std::string metric_label(const std::string& key) {
  if (const Known* known = find_known(key)) return std::string(known->label);
  std::string text = last_part(key);
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string metric_value(const std::string& key, const Json& value) {
  if (value.is_null()) return "not finite";
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_string()) return escaped(value.get<std::string>());
  if (!value.is_number()) return escaped(value.dump());
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

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string light_label(const std::string& light) {
  const LightSpec spec = parse_light_spec(light);
  const auto colour = [&] {
    const auto& [r, g, b] = spec.colour;
    return r == g && g == b ? fmt::format("{:g}", r) : fmt::format("{:g}, {:g}, {:g}", r, g, b);
  };
  if (spec.kind == LightSpec::Kind::ambient) return "Ambient, radiance " + colour();
  const auto degrees = [](double angle) { return fmt::format("{}{:g}°", angle < 0 ? "−" : "", std::abs(angle)); };
  std::string text =
      "Directional, azimuth " + degrees(spec.azimuth_degrees) + ", elevation " + degrees(spec.elevation_degrees);
  if (spec.colour != std::array<float, 3>{1, 1, 1}) text += ", radiance " + colour();
  return text;
}

}  // namespace kiln
