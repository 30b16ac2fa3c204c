// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/summary.h"

#include <cmath>
#include <fmt/format.h>

#include "base/file_names.h"
#include "base/json.h"

namespace kiln {

Json to_json(const std::vector<AssetOutcome>& assets, int status, double seconds) {
  Json list = Json::array();
  for (const AssetOutcome& asset : assets) {
    Json stages = Json::array();
    for (const StageOutcome& stage : asset.stages) {
      Json entry = {{"stage", stage.stage}, {"state", stage.state}};
      if (!stage.reason.empty()) entry["reason"] = stage.reason;
      if (stage.state == "built" || stage.state == "failed") {
        entry["status"] = stage.status;
        entry["seconds"] = stage.seconds;
      }
      stages.push_back(entry);
    }
    Json entry = {{"name", asset.name}, {"status", asset.status}, {"folder", text_of_path(asset.folder)}};
    if (!asset.error.empty()) entry["error"] = asset.error;
    if (!asset.report.empty()) entry["report"] = text_of_path(asset.report);
    entry["stages"] = stages;
    entry["budgets"] = asset.budgets;
    list.push_back(entry);
  }
  return {{"status", status}, {"seconds", seconds}, {"assets", list}};
}

std::string measure_text(double value, double limit) {
  constexpr int fewest = 4, most = 17;
  for (int digits = fewest; digits < most; ++digits) {
    std::string text = fmt::format("{:.{}g}", value, digits);
    if (value == limit || std::stod(text) != limit) return text;
  }
  return fmt::format("{:.{}g}", value, most);
}

}  // namespace kiln
