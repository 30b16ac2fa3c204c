// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/gate/comparison_page.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/file_names.h"
#include "base/html.h"
#include "kiln/index_page.h"
#include "kiln/page_frame.h"
#include "report/labels.h"

namespace kiln {

namespace {

// Rules of this page.
constexpr const char* comparison_style = R"css(
.pictures { display: grid; gap: 12px; grid-template-columns: repeat(3, 1fr); margin: 14px 0; }
figure { overflow: hidden; }
figure img { display: block; width: 100%; }
figcaption { padding: 6px 10px; font-size: 13px; color: var(--soft); }
summary { cursor: pointer; margin: 12px 0; color: var(--accent); }
@media (max-width: 640px) { .pictures { grid-template-columns: 1fr; } }
)css";

/// Order of the kinds on the page, with their names.
struct KindName {
  ChangeKind kind;
  const char* name;
  const char* css;
};
constexpr KindName kinds[] = {{ChangeKind::worse, "worse", "bad"},  {ChangeKind::better, "better", "good"},
                              {ChangeKind::gone, "gone", ""},       {ChangeKind::added, "added", ""},
                              {ChangeKind::changed, "changed", ""}, {ChangeKind::small, "small", "note"},
                              {ChangeKind::noise, "noise", "note"}, {ChangeKind::same, "same", "note"}};

const KindName& named(ChangeKind kind) {
  return *std::ranges::find_if(kinds, [&](const KindName& each) { return each.kind == kind; });
}

std::string change_row(const AssetGate& asset, const MetricChange& change) {
  const KindName& kind = named(change.kind);
  const BudgetVerdict* budget = budget_of(asset, change.metric);
  std::string limit;
  if (budget != nullptr)
    limit = fmt::format("<span class={}>{} {}{}</span>", budget->met ? "good" : "bad",
                        budget->budget.is_highest ? "at most" : "at least", number_text(budget->budget.limit),
                        is_near(*budget) ? ", near" : "");
  const bool has_was = change.kind != ChangeKind::added, has_now = change.kind != ChangeKind::gone;
  const std::string stage = change.metric.substr(0, change.metric.find('.'));
  return fmt::format(
      "<tr title='{}'><td>{}: {}<td class=number>{}<td class=number>{}<td class=number>{}<td class='{}'>{}<td>{}\n",
      html_escaped(change.metric), html_escaped(stage), metric_label(change.metric),
      has_was ? metric_value(change.metric, Json(change.was)) : "",
      has_now ? metric_value(change.metric, Json(change.now)) : "",
      has_was && has_now && change.kind != ChangeKind::same ? relative_text(change.relative()) : "", kind.css,
      kind.name, limit);
}

std::string rows_of(const AssetGate& asset, bool quiet_ones) {
  std::string rows;
  for (const KindName& kind : kinds) {
    const bool is_quiet =
        kind.kind == ChangeKind::same || kind.kind == ChangeKind::noise || kind.kind == ChangeKind::small;
    if (is_quiet != quiet_ones) continue;
    std::vector<MetricChange> changes;
    std::ranges::copy_if(asset.changes, std::back_inserter(changes),
                         [&](const MetricChange& change) { return change.kind == kind.kind; });
    std::ranges::stable_sort(changes, std::greater<>(),
                             [](const MetricChange& change) { return std::abs(change.relative()); });
    for (const MetricChange& change : changes) rows += change_row(asset, change);
  }
  return rows;
}

std::string table_of(const std::string& rows) {
  return "<div class=scroll><table><thead><tr><th>Metric<th class=number>Was<th class=number>Now<th class=number>Change"
         "<th>Verdict<th>Budget</thead><tbody>\n" +
         rows + "</tbody></table></div>\n";
}

std::string pictures_of(const AssetGate& asset) {
  if (!asset.picture) return "";
  const std::string stem = std::string(comparison_folder) + "/" + url_escaped(asset.name);
  const auto figure = [&](const char* suffix, const std::string& caption) {
    return fmt::format("<figure><img src='{}_{}.png' alt='{}' loading=lazy><figcaption>{}</figcaption></figure>\n",
                       stem, suffix, html_escaped(asset.name + ": " + caption), caption);
  };
  const PictureChange& change = *asset.picture;
  const std::string words =
      change.is_same()
          ? "no pixel differs"
          : fmt::format("difference, 8 times: mean shift {:+.2f}, sigma {:.2f}, largest {} of 255; {}",
                        change.mean_shift, change.sigma, change.largest, change.is_drift ? "drift" : "no drift");
  return "<div class=pictures>\n" + figure("was", "baseline") + figure("now", "this build") +
         figure("difference", words) + "</div>\n";
}

std::string budgets_of(const AssetGate& asset) {
  if (asset.budgets.empty()) return "<p class=note>No budgets set.</p>\n";
  const std::size_t missed = missed_budgets(asset.budgets);
  if (missed == 0)
    return fmt::format("<p class=good>✓ {} of {} budgets met</p>\n", asset.budgets.size(), asset.budgets.size());
  std::string html =
      fmt::format("<p class=bad>✗ {} of {} budgets missed</p>\n<ul class=bad>\n", missed, asset.budgets.size());
  for (const BudgetVerdict& verdict : asset.budgets)
    if (!verdict.met)
      html +=
          fmt::format("<li>{}: {}\n", html_escaped(verdict.budget.metric), html_escaped(verdict_text(asset, verdict)));
  return html + "</ul>\n";
}

std::string section(const AssetGate& asset) {
  std::string html = fmt::format("<section><h2>{}</h2>\n", html_escaped(asset.name));
  for (const std::string& fault : {asset.fault, asset.picture_fault})
    if (!fault.empty()) html += fmt::format("<p class=bad>✗ {}</p>\n", html_escaped(fault));
  if (!asset.metrics.is_object()) return html + "</section>\n";
  html += budgets_of(asset) + pictures_of(asset);
  if (!asset.has_baseline) return html + "<p class=note>Not in the baseline: new.</p></section>\n";
  const std::string loud = rows_of(asset, false), quiet = rows_of(asset, true);
  html += loud.empty() ? "<p class=note>No metric changed.</p>\n" : table_of(loud);
  if (!quiet.empty())
    html += "<details><summary>Unchanged, small changes, and noise</summary>\n" + table_of(quiet) + "</details>\n";
  return html + "</section>\n";
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json to_json(const AssetGate& asset) {
  Json json = {{"name", text_of_path(asset.name)}, {"failures", asset.failures()}};
  if (!asset.fault.empty()) json["fault"] = asset.fault;
  if (!asset.picture_fault.empty()) json["picture_fault"] = asset.picture_fault;
  json["budgets"] = Json::array();
  for (const BudgetVerdict& verdict : asset.budgets) {
    Json entry = kiln::to_json(verdict);
    entry["near"] = is_near(verdict);
    json["budgets"].push_back(entry);
  }
  json["changes"] = Json::array();
  for (const MetricChange& change : asset.changes) {
    Json entry = {{"metric", change.metric}, {"verdict", to_string(change.kind)}};
    if (change.kind != ChangeKind::added) entry["was"] = number(change.was);
    if (change.kind != ChangeKind::gone) entry["now"] = number(change.now);
    if (change.uncertainty > 0) entry["uncertainty"] = change.uncertainty;
    json["changes"].push_back(entry);
  }
  if (asset.picture)
    json["picture"] = {{"mean_shift", asset.picture->mean_shift},
                       {"sigma", asset.picture->sigma},
                       {"largest", asset.picture->largest},
                       {"drift", asset.picture->is_drift}};
  return json;
}

}  // namespace

std::string to_string(ChangeKind kind) { return named(kind).name; }

std::string comparison_html(const Gate& gate) {
  std::string body;
  for (const std::string& fault : gate.faults) body += fmt::format("<p class=bad>✗ {}</p>\n", html_escaped(fault));
  for (const AssetGate& asset : gate.assets) body += section(asset);
  const std::size_t failures = gate.failures();
  const std::string summary =
      failures == 0 ? "<span class=good>✓ nothing fails</span>"
                    : fmt::format("<span class=bad>✗ {} failure{}</span>", failures, failures == 1 ? "" : "s");
  const std::string heading = html_escaped(gate.pipeline) + " against its baseline";
  const char* times =
      gate.settings.same_run ? "times are of the same run" : "times are not compared: the baseline is of another run";
  return framed({heading, heading, summary + "; " + times, comparison_style, body});
}

Json to_json(const Gate& gate) {
  Json json = {{"format", "kiln-comparison"},        {"version", 1},          {"failures", gate.failures()},
               {"same_run", gate.settings.same_run}, {"faults", gate.faults}, {"assets", Json::array()}};
  for (const AssetGate& asset : gate.assets) json["assets"].push_back(to_json(asset));
  return json;
}

}  // namespace kiln
