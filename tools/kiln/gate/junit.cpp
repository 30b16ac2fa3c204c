// SPDX-License-Identifier: GPL-3.0-or-later
// JUnit XML as the schema of Jenkins' xUnit plug-in has it: testsuites, testsuite, testcase, failure, error.
#include "kiln/gate/junit.h"

#include <fmt/format.h>

#include "base/html.h"

namespace kiln {

namespace {

/// A test case: what failed, or nothing.
struct Case {
  std::string name;
  std::string failure;  ///< empty: it passes
  std::string kind;     ///< "budget", "picture", "build" or "comparison"
};

std::vector<Case> cases_of(const AssetGate& asset) {
  std::vector<Case> cases = {{"builds", asset.fault, "build"}};
  for (const BudgetVerdict& verdict : asset.budgets)
    cases.push_back({fmt::format("{} {} {}", verdict.budget.metric, verdict.budget.is_highest ? "at most" : "at least",
                                 number_text(verdict.budget.limit)),
                     verdict.met ? "" : verdict_text(asset, verdict), "budget"});
  if (asset.has_baseline || !asset.picture_fault.empty()) cases.push_back({"picture", asset.picture_fault, "picture"});
  return cases;
}

std::string suite(const std::string& name, const std::vector<Case>& cases, double seconds) {
  std::string body;
  std::size_t failures = 0;
  for (const Case& each : cases) {
    body += fmt::format("    <testcase classname=\"{}\" name=\"{}\"", html_escaped(name), html_escaped(each.name));
    if (each.failure.empty()) {
      body += "/>\n";
      continue;
    }
    ++failures;
    const std::string text = html_escaped(each.failure);
    body += fmt::format(">\n      <failure type=\"{}\" message=\"{}\">{}</failure>\n    </testcase>\n", each.kind, text,
                        text);
  }
  return fmt::format(
      "  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"0\" time=\"{:.3f}\">\n{}"
      "  </testsuite>\n",
      html_escaped(name), cases.size(), failures, seconds, body);
}

/// Adds up the time of an asset's stages.
double seconds_of(const AssetGate& asset) {
  double seconds = 0;
  if (!asset.metrics.is_object()) return seconds;
  for (const auto& [stage, record] : asset.metrics.items())
    if (record.is_object()) seconds += record.value("seconds", 0.0);
  return seconds;
}

}  // namespace

std::string junit_xml(const Gate& gate) {
  std::string suites;
  std::size_t tests = 0;
  if (!gate.faults.empty()) {
    std::vector<Case> cases;
    for (const std::string& fault : gate.faults) cases.push_back({"comparison", fault, "comparison"});
    tests += cases.size();
    suites += suite(gate.pipeline, cases, 0);
  }
  for (const AssetGate& asset : gate.assets) {
    const std::vector<Case> cases = cases_of(asset);
    tests += cases.size();
    suites += suite(asset.name, cases, seconds_of(asset));
  }
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"{}\" tests=\"{}\" failures=\"{}\" "
      "errors=\"0\">\n{}</testsuites>\n",
      html_escaped(gate.pipeline), tests, gate.failures(), suites);
}

}  // namespace kiln
