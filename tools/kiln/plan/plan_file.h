// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kiln/pipeline.h"
#include "kiln/plan/choice.h"
#include "kiln/plan/color_hint.h"

namespace kiln {

/// Metric that a plan keeps.
inline constexpr const char* error_metric = "report.error.total";

/// A setting of a plan, and why it is so.
struct PlanLine {
  std::string setting;  ///< "bake.directions"
  std::string value;
  std::string reason;
};

/// What a plan says of one asset.
struct PlannedAsset {
  std::string name;
  double asked = 0;             ///< E
  std::string left_alone;       ///< why nothing is planned for it; empty if something is
  std::vector<PlanLine> lines;  ///< in the order of the stages
  Prediction prediction;
  std::optional<Prediction> of_final;   ///< what the preset `final` costs
  std::optional<ColorHint> color = {};  ///< whether red, green and blue are enough, where that is a question
};

/// Writes a plan that people read, change and commit. `pipeline` is relative to the file's folder, or absolute;
/// `pilot_seconds` what measuring took.
void write_plan(const std::filesystem::path& file, const std::filesystem::path& pipeline,
                const std::vector<PlannedAsset>& assets, double pilot_seconds);

/// Returns the pipeline file that a plan names, as seen from the current folder. Throws BadInput where it names none.
std::filesystem::path pipeline_of_plan(const std::filesystem::path& file);

/// Gives the pipeline's assets the settings of a plan, its errors as budgets, and to their reports what it predicts.
/// Throws BadInput, with the line, for assets that the pipeline has not, and for settings that it would refuse itself.
void apply_plan(Pipeline& pipeline, const std::filesystem::path& file);

}  // namespace kiln
