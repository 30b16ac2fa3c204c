// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/next_steps.h"

#include <fmt/format.h>
#include <utility>

#include "base/html.h"
#include "base/json.h"
#include "report/cause_texts.h"
#include "report/labels.h"

namespace kiln {

namespace {

/// Cause of the largest error, or none.
std::pair<std::string, double> largest_cause(const Json& metrics) {
  std::pair<std::string, double> largest{"", 0};
  const Json error = metrics.value("error", Json::object());
  const Json causes = error.value("causes", Json::object());
  for (const auto& [name, value] : causes.items())
    if (value.is_number() && value.get<double>() > largest.second) largest = {name, value.get<double>()};
  return largest;
}

/// Returns settings that change a metric; empty where none is known.
std::string remedy_of(const std::string& metric, const Json& metrics) {
  constexpr std::pair<const char*, const char*> remedies[] = {
      {"simplify.hausdorff", "more triangles (<code>simplify: {faces}</code>), or <code>quality: best</code>"},
      {"simplify.rms", "more triangles (<code>simplify: {faces}</code>), or <code>quality: best</code>"},
      {"simplify.triangles", "fewer <code>faces</code> of simplify"},
      {"simplify.uv_deviation", "more triangles (<code>simplify: {faces}</code>)"},
      {"atlas.utilisation", "a smaller <code>gutter</code>, or another <code>size</code> of atlas"},
      {"atlas.stretch", "a mesh without folds within charts, or more charts"},
      {"atlas.overlapping_texels", "<code>atlas: {uv: new}</code>"},
      {"normals.", "a larger atlas, more <code>samples</code>, or a better <code>cage</code>"},
      {"bake.bytes_out", "fewer bands, a smaller atlas, or <code>compress</code>"},
      {"bake.quantisation_error", "<code>bake: {bits: 16}</code>"},
      {"bake.verification", "more <code>directions</code> of bake"},
      {"compress.bytes_out", "a larger <code>max-error</code> of compress"},
      {"compress.error", "a smaller <code>max-error</code> of compress"},
      {"report.silhouette_difference", "more triangles (<code>simplify: {faces}</code>)"},
  };
  if (metric.starts_with("error.causes.") || metric.starts_with("report.error.causes."))
    if (const CauseText* text = find_cause_text(metric.substr(metric.rfind('.') + 1))) return text->remedy;
  for (const auto& [beginning, remedy] : remedies)
    if (metric.starts_with(beginning)) return remedy;
  if (metric.starts_with("error.") || metric.starts_with("report."))
    if (const CauseText* text = find_cause_text(largest_cause(metrics).first)) return text->remedy;
  return "";
}

std::string missed_line(const BudgetVerdict& verdict, const Json& metrics) {
  const std::string& metric = verdict.budget.metric;
  const std::string remedy = remedy_of(metric, metrics);
  return fmt::format("<li class=bad><b>{}</b> is {}, {} {}{}</li>\n", html_escaped(metric_label(metric)),
                     metric_value(metric, verdict.value), verdict.budget.is_highest ? "above" : "below",
                     metric_value(metric, verdict.budget.limit), remedy.empty() ? "" : ": try " + remedy);
}

}  // namespace

std::string next_steps(std::span<const BudgetVerdict> verdicts, const Json& metrics) {
  std::string lines;
  for (const BudgetVerdict& verdict : verdicts)
    if (!verdict.met) lines += missed_line(verdict, metrics);
  const auto [cause, error] = largest_cause(metrics);
  const CauseText* text = find_cause_text(cause);
  if (text != nullptr)
    lines += fmt::format("<li>{}To come nearer to the original, {} would help most.</li>\n",
                         lines.empty() && !verdicts.empty() ? "Nothing has to be done. " : "", text->remedy);
  if (verdicts.empty())
    lines +=
        "<li>No budgets are set: <code>budgets: {error.total: {max: 0.08}}</code> in pipeline.yaml makes builds "
        "fail where an asset misses one.</li>\n";
  return lines.empty() ? "" : "<ul class=next>\n" + lines + "</ul>\n";
}

}  // namespace kiln
