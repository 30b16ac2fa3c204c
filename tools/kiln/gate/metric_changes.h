// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/options.h"
#include "report/budget.h"

namespace kiln {

/// What became of a metric between two builds.
enum class ChangeKind {
  same,     ///< equal to nine digits
  noise,    ///< both lie within each other's measured uncertainty
  small,    ///< changed by less than ChangeSettings::least_change
  better,   ///< changed in the direction that is better
  worse,    ///< changed in the direction that is worse
  changed,  ///< a fact of which neither direction is better, such as a number of triangles
  added,    ///< the baseline has none
  gone,     ///< only the baseline has one
};

struct MetricChange {
  std::string metric;  ///< "simplify.hausdorff"
  ChangeKind kind = ChangeKind::same;
  double was = 0;
  double now = 0;
  double uncertainty = 0;  ///< of the difference, 95 % confidence; 0 where the stages state none

  /// Returns (now - was) / |was|; infinite where only one of them is zero.
  double relative() const;
};

struct ChangeSettings {
  bool same_run = false;       ///< whether both builds ran on one machine in one run, so that their times compare
  double least_change = 0.01;  ///< least relative change of other metrics that counts; below it is small
  double time_change = 0.1;    ///< least relative change of a time that counts; below it is noise
};

/// Returns every number and boolean of `metrics` (content of metrics.json) as "STAGE.METRIC", in the file's order;
/// settings, hashes, budgets and lists are none.
std::vector<std::pair<std::string, double>> numbers_of(const Json& metrics);

/// Compares all metrics of two builds, in the order of `now`; those that are gone come last. Times and memory are left
/// out unless both builds ran in the same run.
std::vector<MetricChange> compare_metrics(const Json& was, const Json& now, const ChangeSettings& settings);

/// Tells whether a budget that is met is so by less than a twentieth of its limit.
bool is_near(const BudgetVerdict& verdict);

/// Returns the report's verdicts, as metrics.json holds them.
std::vector<BudgetVerdict> verdicts_of(const Json& metrics);

}  // namespace kiln
