// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "kiln/overrides.h"
#include "kiln/pipeline.h"

namespace kiln {

/// A setting and the values that a sweep gives it.
struct SweepAxis {
  std::string stage;
  std::string setting;
  std::vector<std::string> values;

  std::string name() const { return stage + "." + setting; }
};

/// Settings of one point of a sweep, over those of the pipeline.
struct SweepPoint {
  std::string name;    ///< "today", "thesis", "patent"; empty on the grid
  Overrides settings;  ///< "bake.directions" and its text
};

/// Reads "STAGE.SETTING=VALUE,VALUE,...". Throws WrongUsage for unknown stages and settings, values that the setting
/// does not take, and values given twice.
SweepAxis parse_axis(const std::string& text);

/// Returns every combination of the axes' values. Settings of later stages vary fastest, so that what earlier stages
/// made serves several points. Throws WrongUsage for a setting given twice.
std::vector<SweepPoint> grid_points(std::vector<SweepAxis> axes);

/// Returns the settings of [Chapter 2010] (10,000 stratified directions, 5 bands, 512 x 512 texels of 8 bits, the low
/// mesh as occluder) and of [US 7,948,490] (the same with depth maps of 16 bits).
std::vector<SweepPoint> historic_points();

/// Returns the pipeline with a point's settings in every asset, and without budgets; a setting removes those that it
/// excludes. Throws WrongUsage for settings that exclude each other or cannot work in a pipeline.
Pipeline pipeline_at(const Pipeline& pipeline, const SweepPoint& point);

/// Formats a point for people: "bake.directions 256, atlas.size 128"; its name where it has one.
std::string point_label(const SweepPoint& point);

}  // namespace kiln
