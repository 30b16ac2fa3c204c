// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "base/asset_layout.h"
#include "base/html.h"
#include "base/json.h"
#include "maps/texel_way.h"
#include "report/error_section.h"
#include "report/labels.h"
#include "report/levels_section.h"
#include "report/page_live.h"
#include "report/page_style.h"
#include "report/page_summary.h"
#include "report/page_tables.h"
#include "report/pictures.h"
#include "report/tradeoff.h"
#include "report/transport.h"
#include "report/verdicts.h"
#include "sh/basis.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

/// Returns words on a difference that the noise of its reference may hide more than a tenth of; else none.
std::string noise_of(double difference, double uncertainty) {
  if (uncertainty <= 0.1 * difference) return {};
  return fmt::format(", up to {} more by the reference's noise", metric_value("relative_l2", uncertainty));
}

constexpr double difference_gain = 8, compressed_gain = 32;
constexpr int crop_margin = 12;  // pixels
constexpr int texture_pixels = 640;
constexpr int pyramid_bands = 6;  // rows of more bands are too long to be seen
constexpr int pyramid_pixels = 192;
constexpr int sheet_pixels = 96;

std::string image(const std::string& source, const std::string& description, int width, int height) {
  return fmt::format("<img src='{}' alt='{}' width={} height={}>", source, html_escaped(description), width, height);
}

std::string image(const Image<std::uint8_t>& picture, const std::string& description, const fs::path& scratch) {
  return image(data_uri(picture, scratch), description, picture.width(), picture.height());
}

std::string figure(const std::string& picture, const std::string& caption) {
  return "<figure>" + picture + "<figcaption>" + caption + "</figcaption></figure>\n";
}

/// Part of the pictures that is not empty, with a margin.
struct Crop {
  int left = 0, bottom = 0, width = 0, height = 0;
};

Crop crop_of(const LightComparison& light) {
  const Image<float>& a = light.asset;
  int left = a.width(), right = 0, bottom = a.height(), top = 0;
  for (int j = 0; j < a.height(); ++j)
    for (int i = 0; i < a.width(); ++i)
      if (a.at(i, j, 3) > 0 || light.reference.at(i, j, 3) > 0) {
        left = std::min(left, i);
        right = std::max(right, i);
        bottom = std::min(bottom, j);
        top = std::max(top, j);
      }
  if (right < left) return {0, 0, a.width(), a.height()};
  left = std::max(0, left - crop_margin);
  bottom = std::max(0, bottom - crop_margin);
  right = std::min(a.width() - 1, right + crop_margin);
  top = std::min(a.height() - 1, top + crop_margin);
  return {left, bottom, right - left + 1, top - bottom + 1};
}

Image<std::uint8_t> cropped(const Image<std::uint8_t>& picture, const Crop& crop) {
  Image<std::uint8_t> part(crop.width, crop.height, picture.channels());
  for (int j = 0; j < crop.height; ++j)
    for (int i = 0; i < crop.width; ++i)
      std::copy_n(picture.pixel(crop.left + i, crop.bottom + j).begin(), picture.channels(), part.pixel(i, j).begin());
  return part;
}

std::string relit_section(const AssetFolder& asset, const Report& report, const Json& metrics,
                          const fs::path& scratch) {
  const Comparison& comparison = report.comparison;
  const Json settings = metrics.at("report").value("settings", Json::object());
  std::string html = fmt::format(
      "<section><h2>Relit</h2>\n<p class=note>The asset, drawn by kiln-render from its own files, beside the high "
      "mesh: the same transfer integral "
      "by rays over {} directions at every sample, projected on the same {} bands and lit by the same windowed light. "
      "Differences are "
      "taken in linear radiance over the {} pixels that both cover; the silhouettes differ in {} of their "
      "pixels.</p>\n",
      settings.value("directions", Json("–")).dump(), asset.baked.bands,
      metric_value("pixels", comparison.compared_pixels),
      metric_value("silhouette_difference", comparison.silhouette_difference));
  if (!comparison.lamp.empty())
    html += fmt::format(
        "<p class=note>Transfer is at {} wavelengths. Pictures show it in the light of {}, the first of the lamps that "
        "it was made for, as a monitor shows that; the reference follows light at the same wavelengths, off what "
        "surfaces reflect of each. Colours beyond the monitor's are cut off here, not in the numbers.</p>\n",
        asset.baked.channels, html_escaped(comparison.lamp));
  if (const std::size_t bounces = bounces_taken(asset.record("bake")); bounces > 0)
    html += fmt::format(
        "<p class=note>Its light bounces, too: {} time{}, by paths that end in the sky, so without the points of the "
        "surface at which the bake keeps light.</p>\n",
        bounces, bounces == 1 ? "" : "s");
  if (asset.record("bake").contains("subsurface"))
    html +=
        "<p class=note>Light scatters beneath its surface, too, by paths from points where it enters, chosen by "
        "chance: "
        "without texels and their hierarchy. Points that would send out more than they get, which the bake scales "
        "down, "
        "stay as they are.</p>\n";
  const double front = comparison.lights.front().camera_azimuth_degrees;
  html += "<div class=lights>\n";
  for (const LightComparison& light : comparison.lights) {
    const Crop crop = crop_of(light);
    std::string name = light_label(light.light);
    if (light.camera_azimuth_degrees != front)
      name += fmt::format(", seen from azimuth {:g}°", light.camera_azimuth_degrees);
    html += "<div class=light><h3>" + html_escaped(name) + "</h3>\n<div class=quartet>\n";
    html += figure(image(cropped(shown_radiance(light.asset), crop), "Asset: " + name, scratch), "<b>Asset</b>");
    html += figure(image(cropped(shown_radiance(light.reference), crop), "Reference: " + name, scratch),
                   "<b>Reference</b>, high mesh by rays");
    html += figure(image(cropped(shown_difference(light.asset, light.reference, difference_gain), crop),
                         "Difference: " + name, scratch),
                   fmt::format("<b>Difference × {:g}</b> · RMS {} · relative L² {}{} · largest {}"
                               "<div class=scale></div><div class=axis><span>−{:g} "
                               "darker</span><span>0</span><span>brighter +{:g}</span></div>",
                               difference_gain, rounded(light.difference.root_mean_square, 3),
                               metric_value("relative_l2", light.difference.relative_l2),
                               noise_of(light.difference.relative_l2, light.difference.relative_l2_uncertainty),
                               rounded(light.difference.largest, 3), 1 / difference_gain, 1 / difference_gain));
    html +=
        figure(image(cropped(shown_radiance(light.reference_in_full), crop), "In full: " + name, scratch),
               fmt::format("<b>In full</b>, the high mesh under the light itself, not cut to {} bands: relative L² of "
                           "the asset {}",
                           asset.baked.bands, metric_value("relative_l2", light.difference_in_full.relative_l2)));
    html += "</div></div>\n";
  }
  return html + "</div></section>\n";
}

/// Makes the section on compression: the compressed asset beside the plain one under the light that shows the largest
/// difference, and the other candidates.
std::string compression_section(const AssetFolder& asset, const Report& report, const fs::path& scratch) {
  if (asset.compressed.empty()) return "";
  const Json& record = asset.record("compress");
  const Tradeoff tradeoff = read_tradeoff(asset.stage_record("compress"));
  const auto worst =
      std::max_element(report.comparison.lights.begin(), report.comparison.lights.end(),
                       [](const LightComparison& a, const LightComparison& b) {
                         return a.compressed_difference.relative_l2 < b.compressed_difference.relative_l2;
                       });
  const Crop crop = crop_of(*worst);
  const std::string name = light_label(worst->light);
  std::string html = fmt::format(
      "<section><h2>Compressed</h2>\n<p class=note>The same asset as kiln-compress stores it: {}, {} bytes per covered "
      "texel in place of {}, {} texture lookups in place of {}; expected relighting error {}. Pictures under the "
      "light that tells both apart most.</p>\n<div class=trio>\n",
      tradeoff.chosen.name(), rounded(tradeoff.chosen.bytes_per_texel, 3),
      metric_value("bytes_per_texel_in", record.at("bytes_per_texel_in")), tradeoff.chosen.lookups,
      metric_value("lookups_in", record.at("lookups_in")), metric_value("relighting_error", tradeoff.chosen.error));
  html += figure(image(cropped(shown_radiance(worst->asset), crop), "Plain: " + name, scratch), "<b>Plain planes</b>");
  html += figure(image(cropped(shown_radiance(worst->compressed), crop), "Compressed: " + name, scratch),
                 "<b>Compressed</b>");
  html += figure(image(cropped(shown_difference(worst->compressed, worst->asset, compressed_gain), crop),
                       "Difference of the compressed: " + name, scratch),
                 fmt::format("<b>Difference × {:g}</b> · RMS {} · relative L² {} · largest {}", compressed_gain,
                             rounded(worst->compressed_difference.root_mean_square, 3),
                             metric_value("relative_l2", worst->compressed_difference.relative_l2),
                             rounded(worst->compressed_difference.largest, 3)));
  html +=
      "</div>\n<h3>What was tried</h3>\n<p class=note>Each way as coarse as its error allows; sizes but that of the "
      "chosen one by a quick look, some percent too high.</p>\n";
  return html + tradeoff_plot(tradeoff) + "<details><summary>As a table</summary>\n" + tradeoff_table(tradeoff) +
         "</details></section>\n";
}

/// Makes the figure that shows how each texel found its point of the high mesh, with its legend.
std::string match_figure(const fs::path& file, const fs::path& scratch) {
  std::string legend;
  for (std::size_t way = 1; way < texel_way_colors.size(); ++way) {
    const auto& [name, color] = texel_way_colors[way];
    legend += fmt::format("<span class=key><i style='background:rgb({},{},{})'></i>{}</span>", color[0], color[1],
                          color[2], name);
  }
  return figure(image(thumbnail(file, 8, texture_pixels), "How texels found their point", scratch),
                "<b>Match</b> · how texels found their point of the high mesh: " + legend);
}

/// Tells whether albedo.png belongs to that record of the normals stage; an older file may have been left behind.
bool has_albedo_map(const Json& normals) {
  return normals.contains("albedo") && normals["albedo"].contains("error_rms");
}

/// Makes the figures of the further maps that the record of the normals stage names, each with what its ends mean.
std::string map_figures(const Json& normals, const fs::path& folder, const fs::path& scratch) {
  constexpr std::array<std::pair<const char*, const char*>, 7> titles = {{{"ao", "Ambient occlusion"},
                                                                          {"bent-normal", "Bent normals"},
                                                                          {"thickness", "Thickness"},
                                                                          {"curvature", "Curvature"},
                                                                          {"height", "Height"},
                                                                          {"position", "Position"},
                                                                          {"material", "Materials"}}};
  std::string html;
  const Json maps = normals.value("map_files", Json::object());
  for (const auto& [name, title] : titles) {
    if (!maps.contains(name)) continue;
    const Json& map = maps.at(name);
    const fs::path file = folder / map.at("file").get<std::string>();
    if (!map.contains("bits") || !fs::exists(file)) continue;  // EXR files are for programs
    std::string means = fmt::format("{} to {}", rounded(map.value("min", 0.0), 3), rounded(map.value("max", 1.0), 3));
    if (map.contains("colors")) means = fmt::format("{} of them", map.at("colors").size());
    if (map.contains("unit")) means += map.at("unit") == "length" ? " of the mesh's units" : " over the mesh's unit";
    html += figure(image(thumbnail(file, map.at("bits"), texture_pixels), title, scratch),
                   fmt::format("<b>{}</b> · {}; {} bits", title, means, map.at("bits").get<int>()));
  }
  return html;
}

std::string textures_section(const AssetFolder& asset, const fs::path& scratch) {
  if (asset.is_per_vertex()) return "";
  const Json& normals = asset.record("normals");
  const auto value = [](const Json& record, const char* key) {
    return record.contains(key) ? metric_value(key, record[key]) : std::string("–");
  };
  const Json& atlas = asset.record("atlas");
  std::string html = "<section><h2>Textures</h2>\n<div class=pair>\n";
  html +=
      figure(image(thumbnail(asset.folder / layout::atlas_picture, 8, texture_pixels), "Charts of the atlas", scratch),
             fmt::format("<b>Charts</b> · {} charts, {} of the texels covered, stretch L² {}", value(atlas, "charts"),
                         value(atlas, "utilisation"), value(atlas, "stretch_l2")));
  html += figure(
      image(thumbnail(layout::stage_folder(asset.folder, "normals") / layout::normal_map, 16, texture_pixels),
            "Normal map", scratch),
      fmt::format(
          "<b>Normal map</b> · {} space, gutters filled; {} found by rays outwards, {} inwards, {} by nearest point",
          value(normals, "space"), value(normals, "found_by_ray_outwards"), value(normals, "found_by_ray_inwards"),
          value(normals, "found_by_nearest_point")));
  if (const fs::path albedo = layout::stage_folder(asset.folder, "normals") / layout::albedo_map;
      has_albedo_map(normals) && fs::exists(albedo))
    html +=
        figure(image(thumbnail(albedo, 8, texture_pixels), "Albedo", scratch),
               fmt::format("<b>Albedo</b> · from {}; off the high mesh's by {} (root mean square, linear)",
                           html_escaped(normals["albedo"].value("source", "")), value(normals["albedo"], "error_rms")));
  if (const fs::path opacity = layout::stage_folder(asset.folder, "normals") / layout::opacity_map;
      normals.contains("opacity") && fs::exists(opacity))
    html += figure(image(thumbnail(opacity, 8, texture_pixels), "Opacity", scratch),
                   fmt::format("<b>Opacity</b> · nothing is there below a half; {} of the covered texels are",
                               value(normals["opacity"], "share_there")));
  if (const fs::path match = layout::stage_folder(asset.folder, "normals") / layout::match_map; fs::exists(match))
    html += match_figure(match, scratch);
  html += map_figures(normals, layout::stage_folder(asset.folder, "normals"), scratch);
  return html + "</div></section>\n";
}

std::string plane_figure(const AssetFolder& asset, const PrtPlane& plane, int pixels, const fs::path& scratch) {
  const int l = band_of(plane.coefficient), m = plane.coefficient - coefficient_index(l, 0);
  const std::string name = fmt::format("({}, {}{})", l, m < 0 ? "−" : "", std::abs(m));
  return fmt::format("<figure class=plane>{}<figcaption><b>{}</b>{} … {}</figcaption></figure>\n",
                     image(thumbnail(asset.prt() / plane.file, plane.bits, pixels), "Coefficient " + name, scratch),
                     name, rounded(plane.range.lowest, 3), rounded(plane.range.highest, 3));
}

std::string coefficients_section(const AssetFolder& asset, const fs::path& scratch) {
  if (asset.is_per_vertex()) return "";
  std::string html =
      "<section><h2>Transfer coefficients</h2>\n<p class=note>Each plane as it is stored, black its lowest and white "
      "its highest value: band and order "
      "(l, m), and the range. One row is one band.</p>\n";
  for (int channel = 0; channel < asset.baked.channels; ++channel) {
    if (asset.baked.spectrum)
      html += fmt::format("<h3>{} nm</h3>\n", asset.baked.spectrum->wavelengths_nm[static_cast<std::size_t>(channel)]);
    else if (asset.baked.channels > 1)
      html += fmt::format("<h3>Channel {}</h3>\n", channel);
    if (asset.baked.bands > pyramid_bands) {
      html += "<div class=sheet>\n";
      for (const PrtPlane& plane : asset.baked.planes)
        if (plane.channel == channel) html += plane_figure(asset, plane, sheet_pixels, scratch);
      html += "</div>\n";
      continue;
    }
    // All rows share the width of one plane, so that they form a pyramid.
    const int longest_row = 2 * asset.baked.bands - 1;
    html += "<div class=pyramid>\n";
    for (int l = 0; l < asset.baked.bands; ++l) {
      html +=
          fmt::format("<div class=band style='grid-template-columns:repeat({},minmax(0,calc((100% - {}px)/{})))'>\n",
                      2 * l + 1, 8 * (longest_row - 1), longest_row);
      for (const PrtPlane& plane : asset.baked.planes)
        if (plane.channel == channel && band_of(plane.coefficient) == l)
          html += plane_figure(asset, plane, pyramid_pixels, scratch);
      html += "</div>\n";
    }
    html += "</div>\n";
  }
  return html + "</section>\n";
}

std::string footer(const Json& metrics) {
  std::string html = "<footer>";
  html += fmt::format(
      "<p>Kiln {}. All figures of this page are in metrics.json beside it.</p>\n<details><summary>Inputs</summary>\n",
      html_escaped(metrics.at("version").get<std::string>()));
  std::vector<std::string> seen;
  for (const auto& [stage, result] : metrics.items()) {
    if (!result.is_object()) continue;
    const Json inputs = result.value("inputs", Json::object());  // a temporary would not outlive items()
    for (const auto& [file, hash] : inputs.items()) {
      if (std::find(seen.begin(), seen.end(), file) != seen.end()) continue;
      seen.push_back(file);
      html += fmt::format("<div><code>{}</code> {}</div>\n",
                          html_escaped(hash.is_string() ? hash.get<std::string>() : hash.dump()), html_escaped(file));
    }
  }
  return html + "</details></footer>\n";
}

}  // namespace

Image<std::uint8_t> cover_picture(const Report& report) {
  const LightComparison& light = report.comparison.lights.front();
  return cropped(shown_radiance(light.asset), crop_of(light));
}

std::array<int, 4> cover_place(const Report& report) {
  const Crop crop = crop_of(report.comparison.lights.front());
  return {crop.left, crop.bottom, crop.width, crop.height};
}

std::string page_html(const AssetFolder& asset, const Report& report, const Json& metrics,
                      const fs::path& scratch_folder) {
  const fs::path scratch = scratch_folder / "picture.png";
  return "<!doctype html>\n<html lang=en>\n<head>\n<meta charset=utf-8>\n<meta name=viewport "
         "content='width=device-width, initial-scale=1'>\n<title>" +
         html_escaped(asset.name) + " · Kiln report</title>\n<style>\n" + page_style() +
         "</style>\n</head>\n<body><main>\n" +
         page_summary(asset, report, metrics, image(cover_picture(report), "The asset, relit", scratch)) +
         marked_budgets(report.budgets) + error_section(report.comparison) +
         relit_section(asset, report, metrics, scratch) + compression_section(asset, report, scratch) +
         levels_section(report.comparison.levels, scratch) + transport_section(asset.record("bake")) +
         textures_section(asset, scratch) + coefficients_section(asset, scratch) + verification_section(asset) +
         stages_section(metrics) + footer(metrics) + "</main>\n" +
         page_live(asset, report, metrics.at("report").value("settings", Json::object())) + "</body>\n</html>\n";
}

}  // namespace kiln
