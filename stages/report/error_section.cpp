// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/error_section.h"

#include <algorithm>
#include <fmt/format.h>

#include "report/labels.h"

namespace kiln {

namespace {

/// Names and explanations of the causes, in the words of settings that change them.
struct CauseText {
  const char* name;
  const char* label;
  const char* remedy;
};

constexpr CauseText texts[] = {
    {"geometry", "Geometry: another point of the scan is seen", "more triangles"},
    {"texels", "Texels: looked up between their points", "a larger atlas"},
    {"bands", "Bands: what the asset's are too few for", "more bands"},
    {"directions", "Directions: the sky is sampled", "more directions"},
    {"bits", "Bits: values are rounded", "16 bits"},
    {"visibility", "Visibility: what the bake's engine sees", "another backend, larger depth maps"},
    {"bounces", "Bounces and visibility: light that bounces, and what the bake's engine sees", "a smaller bounce-edge"},
    {"seams", "Seams: both sides are made equal", "fewer charts, a larger atlas"},
    {"compression", "Compression", "a smaller max-error of compress"},
};

std::string row(const std::string& label, double error, double largest, const std::string& remedy) {
  return fmt::format(
      "<tr><td>{}<td class=number>{}<td><div class='meter good'><i style='width:{:.1f}%'></i></div><td>{}\n", label,
      metric_value("relighting_error", error), largest > 0 ? 100 * std::min(1.0, error / largest) : 0, remedy);
}

}  // namespace

std::string error_section(const Comparison& comparison) {
  std::string html = "<section><h2>Where the error comes from</h2>\n";
  if (!comparison.error)
    return html + "<p class=note>Not measured: " + escaped(comparison.error_left_out) + ".</p></section>\n";
  const ErrorSplit& split = *comparison.error;
  html += fmt::format(
      "<p class=note>The expected relighting error of what a viewer sees against the high mesh, at {} points of the "
      "surface, each seen from a direction of its own; {} directions by rays. Each cause is measured by changing one "
      "thing; their squares add up to {}.</p>\n<table><thead><tr><th>Cause<th class=number>Error<th><th>Made less "
      "by</thead><tbody>\n",
      metric_value("samples", split.samples), metric_value("directions", split.directions),
      metric_value("relighting_error", split.root_sum()));
  html += row("<b>All together</b>", split.total, split.total, "");
  std::vector<ErrorCause> causes = split.causes;
  std::ranges::stable_sort(causes, std::greater<>(), &ErrorCause::error);
  for (const ErrorCause& cause : causes) {
    const auto* text = std::ranges::find_if(texts, [&](const CauseText& each) { return cause.name == each.name; });
    html += text == std::end(texts) ? row(escaped(cause.name), cause.error, split.total, "")
                                    : row(text->label, cause.error, split.total, text->remedy);
  }
  return html + "</tbody></table></section>\n";
}

}  // namespace kiln
