// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "kiln/sweep/sweep_grid.h"

namespace kiln {

/// What one asset cost and reached at one point of a sweep.
struct SweepResult {
  std::string asset;
  SweepPoint point;
  int status = 0;            ///< exit status of the build; 0 where it made everything
  double seconds = 0;        ///< wall-clock, of all stages
  double cpu_seconds = 0;    ///< of all stages, the loading of programs included
  long long peak_bytes = 0;  ///< largest of a stage
  long long bytes = 0;       ///< of the files that ship: small/ if there is one, else prt/
  Json metrics;              ///< numbers of all records, as "STAGE.METRIC"
  bool is_reused = false;    ///< found from an earlier sweep

  /// Returns a number of the records; nothing where there is none.
  std::optional<double> metric(const std::string& name) const;

  /// Returns the error that the front is made of: E as seen, of the report; without a report the expected relighting
  /// error against rays where the bake verified itself, combined with that of compression; else the report's difference
  /// of pictures; else nothing.
  std::optional<double> error() const;
};

Json to_json(const SweepResult& result);
SweepResult sweep_result_of_json(const Json& json);

/// Reads the records of `stages` of an asset, after a build in its folder: those of others may be of earlier points.
SweepResult read_result(const std::string& asset, const SweepPoint& point, const std::filesystem::path& folder,
                        const std::vector<std::string>& stages);

/// Marks the results that no other of the same asset beats: none has both less cost and less error. `cost` gives
/// either CPU seconds or bytes. Results without an error are never on the front.
std::vector<bool> pareto_front(const std::vector<SweepResult>& results, double (*cost)(const SweepResult&));

/// Formats all results as CSV (RFC 4180): asset, point, settings, costs, error, then every metric that one of them has.
std::string sweep_csv(const std::vector<SweepResult>& results);

}  // namespace kiln
