// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/gate/metric_changes.h"

#include <cmath>
#include <limits>
#include <map>
#include <string_view>

#include "base/json.h"
#include "report/labels.h"

namespace kiln {

namespace {

constexpr std::string_view uncertainty_suffix = "_uncertainty";

bool is_skipped(const std::string& key) { return key == "settings" || key == "inputs" || key == "outputs"; }

void add_numbers(const Json& json, const std::string& prefix, std::vector<std::pair<std::string, double>>& numbers) {
  for (const auto& [key, value] : json.items()) {
    if (is_skipped(key) || (prefix.empty() && key == "error")) continue;  // the report has it, too
    const std::string name = prefix.empty() ? key : prefix + "." + key;
    if (value.is_object())
      add_numbers(value, name, numbers);
    else if (value.is_boolean())
      numbers.emplace_back(name, value.get<bool>() ? 1 : 0);
    else if (value.is_number())
      numbers.emplace_back(name, value.get<double>());
    else if (value.is_null())
      numbers.emplace_back(name, std::numeric_limits<double>::quiet_NaN());  // the JSON has null for it
  }
}

bool is_same(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) == std::isnan(b);
  return a == b || std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b));
}

/// Numbers of one build by name.
using Numbers = std::map<std::string, double>;

double uncertainty_of(const Numbers& numbers, const std::string& metric) {
  const auto found = numbers.find(metric + std::string(uncertainty_suffix));
  return found == numbers.end() || !std::isfinite(found->second) ? 0 : found->second;
}

ChangeKind kind_of(const MetricChange& change, const ChangeSettings& settings) {
  if (is_same(change.was, change.now)) return ChangeKind::same;
  if (std::isnan(change.was) || std::isnan(change.now))
    return std::isnan(change.now) ? ChangeKind::worse : ChangeKind::better;
  const bool is_cost = is_machine_cost(change.metric);
  if (is_cost && std::abs(change.relative()) < settings.time_change) return ChangeKind::noise;
  if (!is_cost && std::abs(change.now - change.was) <= change.uncertainty) return ChangeKind::noise;
  if (std::abs(change.relative()) < settings.least_change) return ChangeKind::small;
  switch (better_direction(change.metric)) {
    case Better::lower:
      return change.now < change.was ? ChangeKind::better : ChangeKind::worse;
    case Better::higher:
      return change.now > change.was ? ChangeKind::better : ChangeKind::worse;
    default:
      return ChangeKind::changed;
  }
}

}  // namespace

double MetricChange::relative() const {
  if (was == now) return 0;
  return was == 0 ? std::copysign(std::numeric_limits<double>::infinity(), now) : (now - was) / std::abs(was);
}

std::vector<std::pair<std::string, double>> numbers_of(const Json& metrics) {
  std::vector<std::pair<std::string, double>> numbers;
  add_numbers(metrics, "", numbers);
  return numbers;
}

std::vector<MetricChange> compare_metrics(const Json& was, const Json& now, const ChangeSettings& settings) {
  const auto earlier = numbers_of(was), later = numbers_of(now);
  const Numbers was_numbers(earlier.begin(), earlier.end()), now_numbers(later.begin(), later.end());
  const auto is_left_out = [&](const std::string& metric) {
    return metric.ends_with(uncertainty_suffix) || metric == "report.budgets_missed" ||
           (is_machine_cost(metric) && !settings.same_run);
  };
  std::vector<MetricChange> changes;
  for (const auto& [metric, value] : later) {
    if (is_left_out(metric)) continue;
    MetricChange& change = changes.emplace_back();
    change.metric = metric;
    change.now = value;
    const auto before = was_numbers.find(metric);
    if (before == was_numbers.end()) {
      change.kind = ChangeKind::added;
      continue;
    }
    change.was = before->second;
    change.uncertainty = std::hypot(uncertainty_of(was_numbers, metric), uncertainty_of(now_numbers, metric));
    change.kind = kind_of(change, settings);
  }
  for (const auto& [metric, value] : earlier)
    if (!is_left_out(metric) && !now_numbers.contains(metric))
      changes.push_back({metric, ChangeKind::gone, value, 0, 0});
  return changes;
}

bool is_near(const BudgetVerdict& verdict) {
  constexpr double margin = 0.05;
  return verdict.met && verdict.budget.limit != 0 &&
         std::abs(verdict.value - verdict.budget.limit) < margin * std::abs(verdict.budget.limit);
}

std::vector<BudgetVerdict> verdicts_of(const Json& metrics) {
  std::vector<BudgetVerdict> verdicts;
  const Json report = metrics.is_object() ? metrics.value("report", Json::object()) : Json::object();
  for (const Json& budget : report.value("budgets", Json::array())) {
    BudgetVerdict& verdict = verdicts.emplace_back();
    verdict.budget = {budget.at("metric").get<std::string>(), budget.at("relation").get<std::string>() == "at most",
                      budget.at("limit").get<double>()};
    const Json& value = budget.at("value");
    verdict.value = value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
    verdict.met = budget.at("met").get<bool>();
  }
  return verdicts;
}

}  // namespace kiln
