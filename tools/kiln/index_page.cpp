// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/index_page.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

#include "base/html.h"
#include "base/json.h"
#include "kiln/page_frame.h"
#include "kiln/summary.h"
#include "report/labels.h"

namespace kiln {

namespace {

// Rules of this page.
constexpr const char* style = R"css(
.summary { margin: 4px 0 28px; }
.assets { display: grid; gap: 20px; grid-template-columns: repeat(auto-fill, minmax(min(100%, 260px), 1fr)); }
.asset { display: flex; flex-direction: column; min-width: 0; overflow: hidden; background: var(--card);
  border: 1px solid var(--line); border-radius: 10px; color: inherit; text-decoration: none; }
a.asset:hover, a.asset:focus-visible { border-color: var(--accent); box-shadow: 0 2px 14px #0000001a; }
.picture { position: relative; display: grid; place-items: center; aspect-ratio: 4 / 3; background: #efedf0; color: var(--soft); }
.picture img { position: absolute; inset: 0; width: 100%; height: 100%; object-fit: contain; }
.text { padding: 14px 16px 16px; }
h2 { margin: 0 0 6px; font-size: 17px; overflow-wrap: anywhere; }
dl { display: grid; grid-template-columns: auto auto; gap: 1px 12px; margin: 10px 0 0; font-size: 13px; }
dt { color: var(--soft); }
dd { margin: 0; text-align: right; font-variant-numeric: tabular-nums; }
.badge { font-size: 13px; font-weight: 600; }
.plain { color: var(--soft); }
.missed { margin: 6px 0 0; padding: 0; list-style: none; font-size: 13px; color: var(--bad); overflow-wrap: anywhere; }
)css";

/// Finds a metric; null if the stage did not write it.
const Json* metric(const Json& metrics, const char* stage, const char* name) {
  const auto record = metrics.find(stage);
  if (record == metrics.end() || !record->is_object()) return nullptr;
  const auto value = record->find(name);
  return value == record->end() || !value->is_number() ? nullptr : &*value;
}

std::string row(const char* label, const std::string& value) {
  return fmt::format("<dt>{}</dt><dd>{}</dd>", label, value);
}

std::string figures(const Json& metrics) {
  std::string html;
  if (const Json* triangles = metric(metrics, "simplify", "triangles"))
    html += row("triangles", grouped(triangles->get<long long>()));
  const Json *width = metric(metrics, "bake", "width"), *height = metric(metrics, "bake", "height");
  if (width != nullptr && height != nullptr)
    html += row("texels", fmt::format("{} × {}", width->get<int>(), height->get<int>()));
  if (const Json* coefficients = metric(metrics, "bake", "coefficients"))
    html += row("coefficients", std::to_string(coefficients->get<int>()));
  if (const Json* error = metric(metrics, "report", "relative_l2"))
    html += row("difference from the original", fmt::format("{:.2g} %", 100 * error->get<double>()));
  if (const Json* bytes = metric(metrics, "compress", "bytes_per_texel_out"))
    html += row("bytes a texel, compressed", fmt::format("{:.2g}", bytes->get<double>()));
  return html.empty() ? "" : "<dl>" + html + "</dl>";
}

Json budgets_of(const Json& metrics) {
  const auto report = metrics.find("report");
  return report != metrics.end() && report->is_object() ? report->value("budgets", Json::array()) : Json::array();
}

bool is_missed(const Json& budget) { return !budget.value("met", true); }

std::string verdict(const Json& metrics) {
  const Json budgets = budgets_of(metrics);
  const auto missed = std::count_if(budgets.begin(), budgets.end(), is_missed);
  if (budgets.empty()) return "<span class='badge plain'>No budgets set</span>";
  if (missed == 0)
    return fmt::format("<span class='badge good'>✓ {} of {} budgets met</span>", budgets.size(), budgets.size());
  std::string html =
      fmt::format("<span class='badge bad'>✗ {} of {} budgets missed</span><ul class=missed>", missed, budgets.size());
  for (const Json& budget : budgets) {
    if (!is_missed(budget)) continue;
    const Json value = budget.value("value", Json());
    const double limit = budget.value("limit", 0.0);
    html += fmt::format("<li>{} is {}, {} {}</li>", html_escaped(budget.value("metric", "")),
                        value.is_number() ? measure_text(value.get<double>(), limit) : "no number",
                        html_escaped(budget.value("relation", "")), measure_text(limit, limit));
  }
  return html + "</ul>";
}

std::string card(const IndexEntry& entry) {
  const std::string folder = url_escaped(entry.name), name = html_escaped(entry.name);
  const bool built = entry.metrics.is_object();
  const std::string picture = built && entry.has_picture
                                  ? fmt::format("<img src='{}/report.png' alt='{}' loading=lazy>", folder, name)
                                  : std::string(built ? "no picture" : "not built");
  const std::string text = built ? verdict(entry.metrics) + figures(entry.metrics)
                                 : fmt::format("<span class='badge plain'>kiln build {}</span>", name);
  const std::string inner =
      fmt::format("<div class=picture>{}</div><div class=text><h2>{}</h2>{}</div>", picture, name, text);
  return built ? fmt::format("<a class=asset href='{}/report.html'>{}</a>\n", folder, inner)
               : fmt::format("<div class=asset>{}</div>\n", inner);
}

}  // namespace

std::string url_escaped(const std::string& name) {
  std::string url;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && (std::isalnum(byte) != 0 || std::string_view("-_.~").find(c) != std::string_view::npos))
      url += c;
    else
      url += fmt::format("%{:02X}", byte);
  }
  return url;
}

std::string index_html(const std::string& pipeline, const std::vector<IndexEntry>& entries) {
  std::size_t built = 0, missing = 0;
  std::string cards;
  for (const IndexEntry& entry : entries) {
    cards += card(entry);
    if (!entry.metrics.is_object()) continue;
    ++built;
    const Json budgets = budgets_of(entry.metrics);
    missing += std::any_of(budgets.begin(), budgets.end(), is_missed) ? 1u : 0u;
  }
  std::string summary = fmt::format("{} of {} asset{} built", built, entries.size(), entries.size() == 1 ? "" : "s");
  if (built > 0)
    summary += missing == 0 ? ", none misses a budget"
                            : fmt::format(", {} miss{} a budget", missing, missing == 1 ? "es" : "");
  const std::string name = html_escaped(pipeline);
  return framed({name, name, summary, style, "<div class=assets>\n" + cards + "</div>\n"});
}

}  // namespace kiln
