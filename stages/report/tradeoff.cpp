// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/tradeoff.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <optional>

#include "base/errors.h"
#include "base/html.h"
#include "base/json.h"
#include "report/labels.h"
#include "report/log_axis.h"

namespace kiln {

namespace {

// Size of the plot, in its own units.
constexpr double plot_width = 1000, plot_height = 460;
constexpr double left = 64, right = plot_width - 24, top = 24, bottom = plot_height - 56;
constexpr LogAxis::Layout axis_layout{1.35, 2e3};
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

std::string text_at(double x, double y, const std::string& anchor, const std::string& text, const char* kind = "") {
  return fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='{}' class='{}'>{}</text>\n", x, y, anchor, kind,
                     html_escaped(text));
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
                     html_escaped(way.name()), rounded(way.bytes_per_texel, 3), rounded(100 * way.error, 3),
                     way.lookups, name);
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

/// What was tried that can be plotted, by scheme and number of clusters.
using Series = std::map<std::pair<std::string, int>, std::vector<StoredWay>>;

/// Both axes of the plot.
struct Axes {
  LogAxis across, up;

  double x(const StoredWay& way) const { return across.place(way.error); }
  double y(const StoredWay& way) const { return up.place(way.bytes_per_texel); }
};

Series series_of(const Tradeoff& tradeoff) {
  Series series;
  for (const StoredWay& way : tradeoff.tried)
    if (way.scheme != "planes" && is_plottable(way))
      series[{way.scheme, way.clusters}].push_back(is_same(way, tradeoff.chosen) ? tradeoff.chosen : way);
  return series;
}

/// Returns the axes over all that is plotted; nothing where nothing is.
std::optional<Axes> axes_over(const Tradeoff& tradeoff) {
  std::vector<double> errors, bytes;
  const auto note = [&](const StoredWay& way) {
    if (!is_plottable(way)) return;
    errors.push_back(way.error);
    bytes.push_back(way.bytes_per_texel);
  };
  for (const StoredWay& way : tradeoff.tried)
    if (way.scheme != "planes") note(way);
  note(tradeoff.plain);
  note(tradeoff.chosen);
  if (errors.empty()) return std::nullopt;
  if (tradeoff.target_error > 0) errors.push_back(tradeoff.target_error);
  return Axes{{errors, left, right, axis_layout}, {bytes, bottom, top, axis_layout}};
}

std::string drawn_axes(const Axes& axes, double target_error) {
  std::string svg;
  for (const double tick : axes.across.ticks()) {
    const double x = axes.across.place(tick);
    svg += fmt::format("<path class=grid d='M{:.1f} {}V{}'/>", x, top, bottom) +
           text_at(x, bottom + 20, "middle", fmt::format("{:g} %", 100 * tick));
  }
  for (const double tick : axes.up.ticks()) {
    const double y = axes.up.place(tick);
    svg += fmt::format("<path class=grid d='M{} {:.1f}H{}'/>", left, y, right) +
           text_at(left - 10, y + 4, "end", fmt::format("{:g}", tick));
  }
  svg +=
      text_at((left + right) / 2, plot_height - 10, "middle", "expected relighting error against the input", "title");
  svg += text_at(left, top - 9, "start", "bytes per covered texel", "title");
  if (target_error > 0) {
    const double x = axes.across.place(target_error);
    svg += fmt::format("<path class=target d='M{:.1f} {}V{}'/>", x, top, bottom) +
           text_at(x + 6, top + 14, "start", "error asked for");
  }
  return svg;
}

/// Draws all candidates, one line for each number of clusters.
std::string drawn_series(const Series& all, const StoredWay& chosen, const Axes& axes) {
  Series series = all;
  std::string svg;
  for (auto& [key, ways] : series) {
    std::stable_sort(ways.begin(), ways.end(),
                     [](const StoredWay& a, const StoredWay& b) { return a.components < b.components; });
    std::string line;
    for (const StoredWay& way : ways)
      line += fmt::format("{}{:.1f} {:.1f}", line.empty() ? "M" : "L", axes.x(way), axes.y(way));
    svg += fmt::format("<path class='line {}' d='{}'/>\n", family_of(ways.front()), line);
  }
  for (const auto& [key, ways] : series) {
    for (const StoredWay& way : ways)
      if (!is_same(way, chosen)) svg += marked(way, axes.x(way), axes.y(way), mark, way.is_feasible ? "" : "beyond");
    const StoredWay& end = ways.front();
    const double x = axes.x(end), y = axes.y(end);
    const bool has_room = x < right - 100;
    if (!is_same(end, chosen))
      svg += text_at(has_room ? x + 11 : x, has_room ? y + 4 : y - 12, has_room ? "start" : "end",
                     key.second == 1 ? "one basis" : fmt::format("{} clusters", key.second), family_of(end));
  }
  return svg;
}

/// Draws the two that matter: plain planes, and what was chosen.
std::string drawn_ends(const Tradeoff& tradeoff, const Axes& axes) {
  std::string svg;
  if (is_plottable(tradeoff.plain)) {
    const double x = axes.x(tradeoff.plain), y = axes.y(tradeoff.plain);
    svg += marked(tradeoff.plain, x, y, mark, "") +
           text_at(x + 13, y + 4, "start", fmt::format("{} planes of 8 bits", tradeoff.plain.components), "strong");
  }
  if (is_plottable(tradeoff.chosen)) {
    const double x = axes.x(tradeoff.chosen), y = axes.y(tradeoff.chosen);
    const bool has_room = x > left + 220;
    const std::string anchor = has_room ? "end" : "start";
    const double text_x = has_room ? x - 16 : x, text_y = has_room ? y - 2 : y + 24;
    svg += marked(tradeoff.chosen, x, y, 1.5 * mark, "chosen") + text_at(text_x, text_y, anchor, "chosen", "strong") +
           text_at(text_x, text_y + 17, anchor, tradeoff.chosen.name());
  }
  return svg;
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
  const std::optional<Axes> axes = axes_over(tradeoff);
  if (!axes) return "<p class=note>Nothing that was tried has an error to plot.</p>\n";
  return fmt::format(
             "<svg class=tradeoff viewBox='0 0 {} {}' role=img aria-label='Bytes per covered texel against expected "
             "relighting error'>\n",
             plot_width, plot_height) +
         drawn_axes(*axes, tradeoff.target_error) + drawn_series(series_of(tradeoff), tradeoff.chosen, *axes) +
         drawn_ends(tradeoff, *axes) + "</svg>\n" + legend();
}

std::string tradeoff_table(const Tradeoff& tradeoff) {
  std::string html =
      "<table><thead><tr><th>Stored as<th class=number>Error<th class=number>Bytes per texel<th "
      "class=number>Lookups<th>"
      "</thead><tbody>\n";
  const auto row = [&](const StoredWay& way, const char* remark) {
    html += fmt::format("<tr><td>{}<td class=number>{}<td class=number>{}<td class=number>{}<td>{}\n",
                        html_escaped(way.name()), metric_value("relighting_error", way.error),
                        rounded(way.bytes_per_texel, 3), way.lookups, remark);
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
