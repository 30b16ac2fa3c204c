// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kiln/pipeline.h"
#include "kiln/plan/choice.h"
#include "kiln/plan/color_hint.h"

namespace kiln {

/// Name of the folder of small builds in a pipeline's output folder; no asset has one that begins with a dot.
inline constexpr const char* pilots_folder = ".pilots";

struct PlanSettings {
  double error = 0;               ///< E; 0: the assets' budgets for report.error.total
  double levels = 0;              ///< the same in levels of 8 bits; 0: not given so
  double bytes = 0;               ///< that an asset may have; 0: any number
  double seconds = 0;             ///< CPU seconds that an asset's build may take; 0: any
  ColorGoal color = {};           ///< of its lamps
  bool names_lights = false;      ///< whether the lamps were asked for, so that what they lack is an error
  std::string least = "both";     ///< cost that is made least: both, seconds or bytes
  std::vector<std::string> keep;  ///< settings that stay as the pipeline has them: "atlas.size"
  std::filesystem::path output = "plan.yaml";
  int jobs = 0;
  bool json = false;
  bool quiet = false;
};

/// Returns E of an error of so many levels of 8-bit sRGB in a mid-grey, of radiance 0.2.
double error_of_levels(double levels);

/// Chooses, for each asset, the cheapest settings that are predicted to keep its error, from small builds of it
/// (plan/pilot.h), and writes them as a plan (plan/plan_file.h). Returns the exit status: 0, or 4 where an asset cannot
/// keep its error, in which case no plan is written. Throws WrongUsage where no error is asked for and for settings
/// that cannot be kept, BadInput where a pilot cannot be built.
int plan(const Pipeline& pipeline, const std::vector<const Asset*>& assets, const PlanSettings& settings);

}  // namespace kiln
