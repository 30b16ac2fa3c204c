// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kiln/pipeline.h"

namespace kiln {

struct SweepSettings {
  std::vector<std::string> axes;  ///< "bake.directions=256,1024"
  bool historic = false;          ///< whether the settings of the thesis and the patent are points, too
  std::string until;              ///< last stage of every point; empty: the report
  std::filesystem::path output;   ///< folder of the results; empty: sweep/ in the pipeline's output folder
  int jobs = 1;                   ///< stages at a time; more than one spoils the times
  bool json = false;
  bool quiet = false;
};

/// Name of the folder of sweeps in a pipeline's output folder.
inline constexpr const char* sweep_folder = "sweep";

/// Builds the assets at every combination of the axes' values, at the pipeline's own settings ("today") and, if asked,
/// at the historic ones, one after another in one folder, so that a stage runs only where its settings or inputs
/// differ from those of the point before. Writes sweep.json, sweep.csv and sweep.html after each point. Points that an
/// earlier sweep has measured, with the same programs and inputs, are not built again. A point that cannot be built
/// is noted with its exit status. Returns the exit status: 0, or that of the gravest failure if no point could be
/// built. Throws WrongUsage for axes that are none.
int sweep(const Pipeline& pipeline, const std::vector<const Asset*>& assets, const SweepSettings& settings);

}  // namespace kiln
