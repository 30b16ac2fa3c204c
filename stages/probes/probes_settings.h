// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "base/options.h"
#include "import/import_settings.h"
#include "material/material_settings.h"
#include "sh/directions.h"

namespace kiln {

struct ProbesSettings {
  std::string grid = "8x8x8";  ///< points along x, y and z
  std::string box = "auto";    ///< box of the grid, object units: X0,Y0,Z0,X1,Y1,Z1
  int bands = 5;               ///< bands of the distant light and of the arriving light
  int directions = 1024;       ///< directions that a point looks into
  Sampling sampling = Sampling::fibonacci;
  std::string bounces = "0";  ///< how often light bounces off the meshes before it reaches a point: a number, or auto
  double bounce_edge = 0.01;  ///< longest edge of the surface points' mesh, as a fraction of the meshes' diagonal
  ImportSettings import = {};
  MaterialSettings material;
};

OptionSet probes_options(ProbesSettings& settings);

/// Parses "NxMxK". Throws WrongUsage.
std::array<int, 3> parse_grid(const std::string& text);
inline constexpr std::size_t most_grid_points = 1u << 18;

/// Parses --bounces: a number of 0 to most_probe_bounces; none for "auto". Throws WrongUsage.
std::optional<int> parse_probe_bounces(const std::string& text);
inline constexpr int most_probe_bounces = 100;

/// Parses "X0,Y0,Z0,X1,Y1,Z1": the lower corner, then the upper one; none for "auto". Throws WrongUsage.
std::optional<std::array<float, 6>> parse_box(const std::string& text);

}  // namespace kiln
