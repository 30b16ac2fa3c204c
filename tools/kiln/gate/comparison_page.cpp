// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/gate/comparison_page.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/file_names.h"
#include "kiln/index_page.h"
#include "report/labels.h"

namespace kiln {

namespace {

// Style sheet, in the colours of the reports.
constexpr const char* style = R"css(
:root { color-scheme: light; --ink: #1d1c22; --soft: #65616e; --line: #dedbe2; --paper: #fbfaf8; --card: #fff;
  --good: #2f6b4f; --bad: #a8322a; --accent: #8a4b2a; }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 15px/1.5 system-ui, sans-serif; }
main { max-width: 1180px; margin: 0 auto; padding: 32px 24px 48px; }
h1 { margin: 0; font-size: 28px; letter-spacing: -0.01em; }
h2 { margin: 40px 0 4px; font-size: 20px; overflow-wrap: anywhere; }
.summary, footer, .note { color: var(--soft); }
.good { color: var(--good); font-weight: 600; } .bad { color: var(--bad); font-weight: 600; }
.pictures { display: grid; gap: 12px; grid-template-columns: repeat(3, 1fr); margin: 14px 0; }
figure { margin: 0; background: var(--card); border: 1px solid var(--line); border-radius: 8px; overflow: hidden; }
figure img { display: block; width: 100%; }
figcaption { padding: 6px 10px; font-size: 13px; color: var(--soft); }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: 14px; }
th, td { padding: 5px 10px 5px 0; border-bottom: 1px solid var(--line); text-align: left; }
.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
th { color: var(--soft); font-weight: 600; }
summary { cursor: pointer; margin: 12px 0; color: var(--accent); }
footer { margin-top: 40px; font-size: 13px; }
@media (max-width: 640px) { main { padding: 20px 14px 32px; } .pictures { grid-template-columns: 1fr; } }
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
  return fmt::format(
      "<!doctype html>\n<html lang=en>\n<meta charset=utf-8>\n"
      "<meta name=viewport content='width=device-width, initial-scale=1'>\n<title>{0} against its baseline – "
      "Kiln</title>\n"
      "<style>{1}</style>\n<main>\n<h1>{0} against its baseline</h1>\n<p class=summary>{2}; {3}</p>\n{4}"
      "<footer>Kiln {5}</footer>\n</main>\n</html>\n",
      html_escaped(gate.pipeline), style, summary,
      gate.settings.same_run ? "times are of the same run" : "times are not compared: the baseline is of another run",
      body, KILN_VERSION);
}

Json to_json(const Gate& gate) {
  Json json = {{"format", "kiln-comparison"},        {"version", 1},          {"failures", gate.failures()},
               {"same_run", gate.settings.same_run}, {"faults", gate.faults}, {"assets", Json::array()}};
  for (const AssetGate& asset : gate.assets) json["assets"].push_back(to_json(asset));
  return json;
}

}  // namespace kiln
