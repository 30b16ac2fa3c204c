// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "kiln/gate/metric_changes.h"
#include "kiln/gate/picture_change.h"

namespace kiln {

/// What CI is told about one asset.
struct AssetGate {
  std::string name;
  std::string fault;                   ///< why it has no metrics, or nothing to compare; empty: it has
  Json metrics;                        ///< metrics.json; null without a report
  std::vector<BudgetVerdict> budgets;  ///< as judged by the report
  bool has_baseline = false;
  Json baseline;  ///< the baseline's metrics.json
  std::vector<MetricChange> changes;
  std::optional<PictureChange> picture;
  std::string picture_fault;  ///< why its picture cannot be compared

  /// Counts what fails: a fault, a fault of the picture, each missed budget.
  std::size_t failures() const;
};

/// Outcome of a build as CI is told it, with or without a baseline.
struct Gate {
  std::string pipeline;  ///< title: the output folder's name
  std::vector<AssetGate> assets;
  bool has_baseline = false;
  ChangeSettings settings;
  std::vector<std::string> faults;  ///< faults of the whole: an empty comparison

  std::size_t failures() const;
};

/// Finds the budget of a metric; null without one.
const BudgetVerdict* budget_of(const AssetGate& asset, const std::string& metric);

/// Returns a metric's value in the baseline; nothing without one.
std::optional<double> baseline_value(const AssetGate& asset, const std::string& metric);

/// Describes a budget: "was 0.0091, now 0.0123, at most 0.01"; without a baseline the first is left out.
std::string verdict_text(const AssetGate& asset, const BudgetVerdict& verdict);

/// Formats a change: "+12.3 %", or "new" from nothing.
std::string relative_text(double relative);

/// Formats a measure for people: four digits.
std::string number_text(double value);

/// Where the baseline of an asset lies: the folder of its metrics.json and pictures.
struct BaselineFolder {
  std::filesystem::path metrics;
  std::filesystem::path picture;
};

/// Finds the baseline of an asset under `baseline`: a metrics.json (whose `asset` is this one), the folder of one, or a
/// folder of such folders, one for each asset, as a build's output is. Nothing where there is none.
std::optional<BaselineFolder> find_baseline(const std::filesystem::path& baseline, const std::string& asset);

/// Reads a built asset in `folder`; a fault stands in the result.
AssetGate read_asset_gate(const std::string& name, const std::filesystem::path& folder);

/// Compares an asset with its baseline; a picture that only one of them has, or that has another size, is a fault.
/// Pictures are copied to `pictures` as ASSET_was.png, ASSET_now.png and ASSET_difference.png.
void compare_with_baseline(AssetGate& asset, const std::filesystem::path& folder, const BaselineFolder& baseline,
                           const std::filesystem::path& pictures, const ChangeSettings& settings);

}  // namespace kiln
