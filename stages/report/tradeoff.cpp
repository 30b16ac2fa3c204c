// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/tradeoff.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

#include "base/errors.h"
#include "base/json.h"
#include "report/labels.h"

namespace kiln {

namespace {

// Size of the plot, in its own units.
constexpr double plot_width = 1000, plot_height = 460;
constexpr double left = 64, right = plot_width - 24, top = 24, bottom = plot_height - 56;
constexpr double mark = 5;  // half of a mark's width

StoredWay read_way(const Json& json, double texels) {
  StoredWay way;
  way.scheme = json.at("scheme").get<std::string>();
  way.clusters = json.at("clusters").get<int>();
  way.components = json.at("components").get<int>();
  way.lookups = json.at("lookups").get<int>();
  way.error = json.at("error").get<double>();
  way.bytes_per_texel = json.at("bytes").get<double>() / texels;
  way.is_feasible = json.at("feasible").get<bool>();
  return way;
}

bool is_same(const StoredWay& a, const StoredWay& b) {
  return a.scheme == b.scheme && a.clusters == b.clusters && a.components == b.components;
}

bool is_plottable(const StoredWay& way) { return way.error > 0 && way.bytes_per_texel > 0; }

/// Logarithmic axis from `low` to `high`, which lie at `at_low` and `at_high`.
struct Axis {
  double low, high, at_low, at_high;

  double place(double value) const {
    return at_low + (at_high - at_low) * std::log(value / low) / std::log(high / low);
  }

  /// Returns 1, 2 and 5 times powers of ten; only the powers where those would be too many.
  std::vector<double> ticks() const {
    std::vector<double> all;
    const bool is_wide = high / low > 2e3;
    for (int power = static_cast<int>(std::floor(std::log10(low))); std::pow(10.0, power) <= high; ++power)
      for (const int times : {1, 2, 5})
        if (const double value = times * std::pow(10.0, power);
            value >= low && value <= high && (times == 1 || !is_wide))
          all.push_back(value);
    return all;
  }
};

Axis axis_over(const std::vector<double>& values, double at_low, double at_high) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  constexpr double margin = 1.35;  // factor beyond the least and greatest value
  return {*least / margin, *most * margin, at_low, at_high};
}

std::string text_at(double x, double y, const std::string& anchor, const std::string& text, const char* kind = "") {
  return fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='{}' class='{}'>{}</text>\n", x, y, anchor, kind,
                     escaped(text));
}

const char* family_of(const StoredWay& way) {
  if (way.scheme == "planes") return "planes";
  return way.scheme == "pca" ? "one" : "several";
}

/// Draws a diamond, a circle or a square, which are distinct without colour.
std::string shape(const StoredWay& way, double x, double y, double size, const std::string& kind) {
  const std::string style = fmt::format("class='{} {}'", family_of(way), kind);
  if (way.scheme == "planes")
    return fmt::format("<path {} d='M{:.1f} {:.1f}l{:.1f} {:.1f} {:.1f} {:.1f} {:.1f} {:.1f}z'>", style, x,
                       y - 1.4 * size, 1.4 * size, 1.4 * size, -1.4 * size, 1.4 * size, -1.4 * size, -1.4 * size);
  if (way.scheme == "pca") return fmt::format("<circle {} cx='{:.1f}' cy='{:.1f}' r='{:.1f}'>", style, x, y, size);
  return fmt::format("<rect {} x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}'>", style, x - size, y - size,
                     2 * size, 2 * size);
}

std::string marked(const StoredWay& way, double x, double y, double size, const std::string& kind) {
  const std::string element = shape(way, x, y, size, kind);
  const std::string name = element.substr(1, element.find(' ') - 1);
  return fmt::format("{}<title>{}: {} bytes per covered texel, error {} %, {} lookups</title></{}>\n", element,
                     escaped(way.name()), rounded(way.bytes_per_texel, 3), rounded(100 * way.error, 3), way.lookups,
                     name);
}

std::string legend() {
  const auto key = [](const char* scheme, const char* kind, const char* meaning) {
    StoredWay way;
    way.scheme = scheme;
    const std::string element = shape(way, 8, 8, mark, kind);
    return fmt::format("<span class=key><svg class=tradeoff width=16 height=16 aria-hidden=true>{}</{}></svg>{}</span>",
                       element, element.substr(1, element.find(' ') - 1), meaning);
  };
  return "<p class=note>" + key("planes", "", "plain planes of 8 bits") + key("pca", "", "one basis") +
         key("clustered-pca", "", "a basis for each cluster") +
         key("clustered-pca", "beyond", "more error than asked for") + key("clustered-pca", "chosen", "chosen") +
         "</p>\n";
}

}  // namespace

std::string StoredWay::name() const {
  if (scheme == "planes") return fmt::format("{} planes", components);
  const std::string basis = clusters == 1 ? "one basis" : fmt::format("{} clusters", clusters);
  return fmt::format("{}, {} component{}", basis, components, components == 1 ? "" : "s");
}

Tradeoff read_tradeoff(const StageRecord& compress) {
  try {
    const double texels = compress.json.at("texels").get<double>();
    Tradeoff tradeoff;
    tradeoff.target_error = compress.json.at("target_error").get<double>();
    tradeoff.plain = read_way(compress.json.at("plain"), texels);
    tradeoff.chosen = read_way(compress.json.at("chosen"), texels);
    for (const Json& candidate : compress.json.at("candidates")) tradeoff.tried.push_back(read_way(candidate, texels));
    if (!(texels > 0)) throw BadInput(compress.file.string(), "no covered texels", "some", "run kiln-compress again");
    return tradeoff;
  } catch (const Json::exception& error) {
    throw BadInput(compress.file.string(), error.what(), "the record of kiln-compress", "run kiln-compress again");
  }
}

std::string tradeoff_plot(const Tradeoff& tradeoff) {
  std::vector<double> errors, bytes;
  std::map<std::pair<std::string, int>, std::vector<StoredWay>> series;  // by scheme and clusters
  const auto note = [&](const StoredWay& way) {
    if (!is_plottable(way)) return;
    errors.push_back(way.error);
    bytes.push_back(way.bytes_per_texel);
  };
  for (const StoredWay& way : tradeoff.tried) {
    if (way.scheme == "planes" || !is_plottable(way)) continue;
    note(way);
    series[{way.scheme, way.clusters}].push_back(is_same(way, tradeoff.chosen) ? tradeoff.chosen : way);
  }
  note(tradeoff.plain);
  note(tradeoff.chosen);
  if (errors.empty()) return "<p class=note>Nothing that was tried has an error to plot.</p>\n";
  if (tradeoff.target_error > 0) errors.push_back(tradeoff.target_error);
  const Axis across = axis_over(errors, left, right), up = axis_over(bytes, bottom, top);

  std::string svg = fmt::format(
      "<svg class=tradeoff viewBox='0 0 {} {}' role=img aria-label='Bytes per covered texel against expected "
      "relighting "
      "error'>\n",
      plot_width, plot_height);
  // Step 1: draw the axes.
  for (const double tick : across.ticks()) {
    const double x = across.place(tick);
    svg += fmt::format("<path class=grid d='M{:.1f} {}V{}'/>", x, top, bottom) +
           text_at(x, bottom + 20, "middle", fmt::format("{:g} %", 100 * tick));
  }
  for (const double tick : up.ticks()) {
    const double y = up.place(tick);
    svg += fmt::format("<path class=grid d='M{} {:.1f}H{}'/>", left, y, right) +
           text_at(left - 10, y + 4, "end", fmt::format("{:g}", tick));
  }
  svg +=
      text_at((left + right) / 2, plot_height - 10, "middle", "expected relighting error against the input", "title");
  svg += text_at(left, top - 9, "start", "bytes per covered texel", "title");
  if (tradeoff.target_error > 0) {
    const double x = across.place(tradeoff.target_error);
    svg += fmt::format("<path class=target d='M{:.1f} {}V{}'/>", x, top, bottom) +
           text_at(x + 6, top + 14, "start", "error asked for");
  }

  // Step 2: draw all candidates, one line for each number of clusters.
  for (auto& [key, ways] : series) {
    std::stable_sort(ways.begin(), ways.end(),
                     [](const StoredWay& a, const StoredWay& b) { return a.components < b.components; });
    std::string line;
    for (const StoredWay& way : ways)
      line += fmt::format("{}{:.1f} {:.1f}", line.empty() ? "M" : "L", across.place(way.error),
                          up.place(way.bytes_per_texel));
    svg += fmt::format("<path class='line {}' d='{}'/>\n", family_of(ways.front()), line);
  }
  for (const auto& [key, ways] : series) {
    for (const StoredWay& way : ways)
      if (!is_same(way, tradeoff.chosen))
        svg +=
            marked(way, across.place(way.error), up.place(way.bytes_per_texel), mark, way.is_feasible ? "" : "beyond");
    const StoredWay& end = ways.front();
    const double x = across.place(end.error), y = up.place(end.bytes_per_texel);
    const bool has_room = x < right - 100;
    if (!is_same(end, tradeoff.chosen))
      svg += text_at(has_room ? x + 11 : x, has_room ? y + 4 : y - 12, has_room ? "start" : "end",
                     key.second == 1 ? "one basis" : fmt::format("{} clusters", key.second), family_of(end));
  }

  // Step 3: draw the two that matter.
  if (is_plottable(tradeoff.plain)) {
    const double x = across.place(tradeoff.plain.error), y = up.place(tradeoff.plain.bytes_per_texel);
    svg += marked(tradeoff.plain, x, y, mark, "") +
           text_at(x + 13, y + 4, "start", fmt::format("{} planes of 8 bits", tradeoff.plain.components), "strong");
  }
  if (is_plottable(tradeoff.chosen)) {
    const double x = across.place(tradeoff.chosen.error), y = up.place(tradeoff.chosen.bytes_per_texel);
    const bool has_room = x > left + 220;
    const std::string anchor = has_room ? "end" : "start";
    const double text_x = has_room ? x - 16 : x, text_y = has_room ? y - 2 : y + 24;
    svg += marked(tradeoff.chosen, x, y, 1.5 * mark, "chosen") + text_at(text_x, text_y, anchor, "chosen", "strong") +
           text_at(text_x, text_y + 17, anchor, tradeoff.chosen.name());
  }
  return svg + "</svg>\n" + legend();
}

std::string tradeoff_table(const Tradeoff& tradeoff) {
  std::string html =
      "<table><thead><tr><th>Stored as<th class=number>Error<th class=number>Bytes per texel<th "
      "class=number>Lookups<th>"
      "</thead><tbody>\n";
  const auto row = [&](const StoredWay& way, const char* remark) {
    html +=
        fmt::format("<tr><td>{}<td class=number>{}<td class=number>{}<td class=number>{}<td>{}\n", escaped(way.name()),
                    metric_value("relighting_error", way.error), rounded(way.bytes_per_texel, 3), way.lookups, remark);
  };
  row(tradeoff.plain, "plain, 8 bits");
  for (const StoredWay& way : tradeoff.tried) {
    if (way.scheme == "planes" && way.error <= tradeoff.plain.error) continue;  // listed above, or the input itself
    const bool is_chosen = is_same(way, tradeoff.chosen);
    row(is_chosen ? tradeoff.chosen : way, is_chosen         ? "<b>chosen</b>"
                                           : way.is_feasible ? ""
                                                             : "more error than asked for");
  }
  return html + "</tbody></table>\n";
}

}  // namespace kiln
