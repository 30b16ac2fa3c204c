// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/sweep/sweep_page.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/html.h"
#include "kiln/page_frame.h"
#include "report/labels.h"
#include "report/log_axis.h"

namespace kiln {

namespace {

// Rules of this page.
constexpr const char* sweep_style = R"css(
.plots { display: grid; gap: 16px; grid-template-columns: repeat(2, 1fr); margin: 14px 0; }
figure { padding: 8px; }
svg { display: block; width: 100%; height: auto; font: 13px system-ui, sans-serif; }
.grid { stroke: var(--line); fill: none; } .title { fill: var(--soft); } .front { stroke: var(--good); fill: none; stroke-width: 1.5; }
.point { fill: #b9b5c0; } .point.best { fill: var(--good); } .named { fill: var(--accent); } .label { fill: var(--accent); font-weight: 600; }
@media (max-width: 760px) { .plots { grid-template-columns: 1fr; } }
)css";

// Size of a plot, in its own units.
constexpr double width = 560, height = 380, left = 66, right = width - 16, top = 30, bottom = height - 50;

/// One of the two costs that errors are plotted against.
struct Cost {
  const char* title;
  double (*of)(const SweepResult&);
};

double cpu_cost(const SweepResult& result) { return result.cpu_seconds; }
double byte_cost(const SweepResult& result) { return static_cast<double>(result.bytes); }

constexpr Cost costs[] = {{"CPU seconds of all stages", cpu_cost}, {"bytes that ship", byte_cost}};

bool is_plottable(const SweepResult& result, const Cost& cost) {
  return result.error().value_or(0) > 0 && cost.of(result) > 0;
}

std::string tick_text(double value, bool is_bytes) {
  if (!is_bytes) return fmt::format("{:g}", value);
  return value >= 1e6 ? fmt::format("{:g} MB", value / 1e6) : fmt::format("{:g} kB", value / 1e3);
}

std::string grid_of(const LogAxis& across, const LogAxis& up, const Cost& cost) {
  std::string svg;
  for (const double tick : across.ticks())
    svg += fmt::format(
        "<path class=grid d='M{0:.1f} {1}V{2}'/><text class=title x='{0:.1f}' y='{3}' text-anchor=middle>{4}</text>\n",
        across.place(tick), top, bottom, bottom + 18, tick_text(tick, cost.of == byte_cost));
  for (const double tick : up.ticks())
    svg += fmt::format(
        "<path class=grid d='M{0} {1:.1f}H{2}'/><text class=title x='{3}' y='{4:.1f}' text-anchor=end>{5:g} %</text>\n",
        left, up.place(tick), right, left - 8, up.place(tick) + 4, 100 * tick);
  return svg + fmt::format(
                   "<text class=title x='{}' y='{}' text-anchor=middle>{}</text>\n<text class=title x='{}' "
                   "y='{}'>error</text>\n",
                   (left + right) / 2, height - 10, cost.title, left, top - 12);
}

/// Draws the front as steps: what a given cost reaches at least.
std::string front_path(std::vector<const SweepResult*> front, const LogAxis& across, const LogAxis& up,
                       const Cost& cost) {
  std::ranges::sort(front, {}, [&](const SweepResult* result) { return cost.of(*result); });
  std::string path;
  for (const SweepResult* result : front) {
    const double x = across.place(cost.of(*result)), y = up.place(*result->error());
    path += path.empty() ? fmt::format("M{:.1f} {:.1f}", x, y) : fmt::format("H{:.1f}V{:.1f}", x, y);
  }
  return path.empty() ? "" : fmt::format("<path class=front d='{}H{}'/>\n", path, right);
}

std::string title_of(const SweepResult& result) {
  return html_escaped(fmt::format("{}: error {}, {:.3g} CPU s, {} bytes", point_label(result.point),
                                  result.error() ? rounded(100 * *result.error(), 3) + " %" : "not measured",
                                  result.cpu_seconds, result.bytes));
}

std::string plot(const std::vector<SweepResult>& results, const Cost& cost) {
  std::vector<double> places, errors;
  for (const SweepResult& result : results)
    if (is_plottable(result, cost)) {
      places.push_back(cost.of(result));
      errors.push_back(*result.error());
    }
  if (places.empty()) return "<p class=note>No point has an error to plot.</p>\n";
  const LogAxis across(places, left, right, {}), up(errors, bottom, top, {});
  const std::vector<bool> best = pareto_front(results, cost.of);
  std::string svg =
      fmt::format("<svg viewBox='0 0 {} {}' role=img aria-label='Error against {}'>\n", width, height, cost.title);
  svg += grid_of(across, up, cost);
  std::vector<const SweepResult*> front;
  for (std::size_t k = 0; k < results.size(); ++k)
    if (best[k] && is_plottable(results[k], cost)) front.push_back(&results[k]);
  svg += front_path(front, across, up, cost);
  for (std::size_t k = 0; k < results.size(); ++k) {
    const SweepResult& result = results[k];
    if (!is_plottable(result, cost)) continue;
    const double x = across.place(cost.of(result)), y = up.place(*result.error());
    const std::string mark =
        result.point.name.empty()
            ? fmt::format("circle class='point{}' cx='{:.1f}' cy='{:.1f}' r=4", best[k] ? " best" : "", x, y)
            : fmt::format("path class=named d='M{:.1f} {:.1f}l6 6 -6 6 -6 -6z'", x, y - 6);
    svg += fmt::format("<{}><title>{}</title></{}>\n", mark, title_of(result), mark.substr(0, mark.find(' ')));
    if (!result.point.name.empty()) {
      const bool has_room = x < right - 60;
      svg += fmt::format("<text class=label x='{:.1f}' y='{:.1f}' text-anchor={}>{}</text>\n",
                         x + (has_room ? 10 : -10), y - 8, has_room ? "start" : "end", result.point.name);
    }
  }
  return "<figure>" + svg + "</svg></figure>\n";
}

std::string table(std::vector<SweepResult> results) {
  const std::vector<bool> best = pareto_front(results, cpu_cost);
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < results.size(); ++k) order.push_back(k);
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return results[k].cpu_seconds; });
  std::string html =
      "<div class=scroll><table><thead><tr><th>Point<th class=number>Error<th class=number>CPU s<th class=number>Wall s"
      "<th class=number>Memory<th class=number>Bytes<th>Front</thead><tbody>\n";
  for (const std::size_t k : order) {
    const SweepResult& result = results[k];
    html += fmt::format(
        "<tr><td>{}<td class=number>{}<td class=number>{:.2f}<td class=number>{:.2f}<td class=number>{}<td "
        "class=number>{}<td class={}>{}\n",
        html_escaped(point_label(result.point)),
        result.status != 0 ? fmt::format("<span class=bad>exit status {}</span>", result.status)
        : result.error()   ? rounded(100 * *result.error(), 3) + " %"
                           : "not measured",
        result.cpu_seconds, result.seconds, metric_value("peak_memory_bytes", Json(result.peak_bytes)), result.bytes,
        best[k] ? "good" : "note", best[k] ? "yes" : "");
  }
  return html + "</tbody></table></div>\n";
}

/// Returns the names of the assets, in the order in which they appear.
std::vector<std::string> assets_of(const std::vector<SweepResult>& results) {
  std::vector<std::string> names;
  for (const SweepResult& result : results)
    if (std::ranges::find(names, result.asset) == names.end()) names.push_back(result.asset);
  return names;
}

}  // namespace

Json sweep_json(const std::vector<SweepResult>& results) {
  const std::vector<bool> by_time = pareto_front(results, cpu_cost), by_bytes = pareto_front(results, byte_cost);
  Json list = Json::array();
  for (std::size_t k = 0; k < results.size(); ++k) {
    Json entry = to_json(results[k]);
    entry["on_time_front"] = static_cast<bool>(by_time[k]);
    entry["on_bytes_front"] = static_cast<bool>(by_bytes[k]);
    list.push_back(entry);
  }
  return {{"format", "kiln-sweep"}, {"version", 1}, {"results", list}};
}

std::string sweep_html(const std::vector<SweepResult>& results) {
  std::string body;
  for (const std::string& name : assets_of(results)) {
    std::vector<SweepResult> own;
    std::ranges::copy_if(results, std::back_inserter(own),
                         [&](const SweepResult& result) { return result.asset == name; });
    body += fmt::format("<section><h2>{}</h2>\n<div class=plots>\n", html_escaped(name));
    for (const Cost& cost : costs) body += plot(own, cost);
    body += "</div>\n" + table(own) + "</section>\n";
  }
  const std::string summary = fmt::format(
      "{} points. Error: the expected relighting error of what a viewer sees; without reports, of the bake against "
      "rays. Green: no other point is both cheaper and nearer.",
      results.size());
  return framed({"Sweep", "Speed against accuracy", summary, sweep_style, body});
}

}  // namespace kiln
