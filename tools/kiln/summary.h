// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "base/json.h"
#include "kiln/pipeline.h"

namespace kiln {

/// Outcome of one stage of one asset.
struct StageOutcome {
  std::string stage;
  std::string state;   ///< "current", "built", "failed", "not reached"; in a dry run "to build"
  std::string reason;  ///< why it had to run
  int status = 0;
  double seconds = 0;
};

/// Outcome of one asset.
struct AssetOutcome {
  std::string name;
  std::string folder;  ///< seen from the current folder
  std::string report;  ///< report.html; empty if it was not made
  int status = 0;
  std::string error;  ///< why nothing of it could be built
  std::vector<StageOutcome> stages;
  Json budgets = Json::array();  ///< as in the report
};

/// Formats the whole build as one JSON object.
Json to_json(const std::vector<AssetOutcome>& assets, int status, double seconds);

/// Formats a measure for people: four digits, or as many as distinguish it from `limit`.
std::string measure_text(double value, double limit);

}  // namespace kiln
