// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/error_section.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

#include "base/html.h"
#include "report/cause_texts.h"
#include "report/labels.h"

namespace kiln {

namespace {

/// Writes the rows of the table, with what a plan predicted where there is one.
class Rows {
 public:
  Rows(double largest, const std::map<std::string, double>& predicted) : largest_(largest), predicted_(predicted) {}

  std::string head() const {
    return fmt::format("<tr><th>Cause<th class=number>Error{}<th><th>Made less by",
                       predicted_.empty() ? "" : "<th class=number>Predicted");
  }

  std::string row(const std::string& name, const std::string& label, double error, const std::string& remedy) const {
    const auto predicted = predicted_.find(name);
    std::string html =
        fmt::format("<tr><td>{}<td class=number data-label=Error>{}", label, metric_value("relighting_error", error));
    if (!predicted_.empty())
      html += "<td class=number data-label=Predicted>" +
              (predicted == predicted_.end() ? "" : metric_value("relighting_error", predicted->second));
    return html +
           fmt::format(
               "<td><div class='meter good'><i style='width:{:.1f}%'></i></div><td data-label='Made less by'>{}\n",
               largest_ > 0 ? 100 * std::min(1.0, error / largest_) : 0, remedy);
  }

 private:
  const double largest_;
  const std::map<std::string, double>& predicted_;
};

/// Says what was asked for, predicted and measured, and what the preset `final` would cost beside.
std::string promise(const std::map<std::string, double>& predicted, double measured) {
  const auto has = [&](const char* name) { return predicted.contains(name); };
  if (!has("asked") || !has("total")) return {};
  std::string text =
      fmt::format("<p class=note>Asked {}, predicted {}, measured <b>{}</b>",
                  metric_value("relighting_error", predicted.at("asked")),
                  metric_value("relighting_error", predicted.at("total")), metric_value("relighting_error", measured));
  const auto cheaper = [&](const char* cost, const char* of_final, const char* unit) {
    if (has(cost) && has(of_final) && predicted.at(cost) > 0)
      text += fmt::format(", {:.1f} times fewer {} than <code>final</code>",
                          predicted.at(of_final) / predicted.at(cost), unit);
  };
  cheaper("cpu_seconds", "final_cpu_seconds", "CPU seconds");
  cheaper("bytes", "final_bytes", "bytes");
  return text + " (costs as predicted).</p>\n";
}

}  // namespace

std::string error_section(const Comparison& comparison) {
  std::string html = "<section><h2>Where the error comes from</h2>\n";
  const ErrorSplit& split = comparison.error;
  const bool by_paths = std::ranges::find(split.causes, "subsurface", &ErrorCause::name) != split.causes.end();
  html += fmt::format(
      "<p class=note>The expected relighting error of what a viewer sees against the high mesh, at {} points of the "
      "surface, each seen from a direction of its own; {} {}. Each cause is measured by changing one thing; their "
      "squares add up to {}.{}</p>\n",
      metric_value("samples", split.samples), metric_value("directions", split.directions),
      by_paths ? "lines of paths beneath the surface from each" : "directions by rays",
      metric_value("relighting_error", split.root_sum()),
      by_paths ? fmt::format(" All together is known within {}; causes below {} may be the paths' noise.",
                             metric_value("relighting_error", split.uncertainty),
                             metric_value("relighting_error", std::sqrt(2 * split.total * split.uncertainty)))
               : "");
  const Rows rows(split.total, comparison.predicted);
  html += promise(comparison.predicted, split.total) + "<table class='folding sortable'><thead>" + rows.head() +
          "</thead><tbody>\n" + rows.row("total", "<b>All together</b>", split.total, "");
  std::vector<ErrorCause> causes = split.causes;
  std::ranges::stable_sort(causes, std::greater<>(), &ErrorCause::error);
  for (const ErrorCause& cause : causes) {
    // One colour, or no atlas: there is nothing to be wrong.
    if ((cause.name == "albedo" || cause.name == "seams") && cause.error == 0) continue;
    const CauseText* text = find_cause_text(cause.name);
    html += text == nullptr ? rows.row(cause.name, html_escaped(cause.name), cause.error, "")
                            : rows.row(cause.name, text->label, cause.error, text->remedy);
  }
  return html + "</tbody></table></section>\n";
}

}  // namespace kiln
