// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "base/options.h"
#include "import/import_settings.h"
#include "material/bounce_settings.h"
#include "material/material_settings.h"
#include "sh/sampling.h"

namespace kiln {

/// The lower corner, then the upper one.
using ProbeBox = std::array<float, 6>;

struct ProbesSettings {
  std::array<int, 3> grid = {8, 8, 8};  ///< points along x, y and z
  std::optional<ProbeBox> box;          ///< of the grid, object units; nothing: around the meshes
  int bands = 5;                        ///< of the light far away and of the light that comes in
  int directions = 1024;                ///< that a point looks into
  Sampling sampling = Sampling::fibonacci;
  BounceTarget bounces;       ///< off the meshes, before light reaches a point; auto: until one adds a thousandth
  double bounce_edge = 0.01;  ///< longest edge of what it bounces off, fraction of the meshes' diagonal
  ImportSettings import = {};
  MaterialSettings material;
};

OptionSet probes_options(ProbesSettings& settings);

/// The largest coordinate of a probe, object units: rays start there, and Embree's cannot from beyond 1e18.
inline constexpr float farthest_probe = 1e12f;

/// Parses "NxMxK". Throws WrongUsage.
std::array<int, 3> parse_grid(const std::string& text);
inline constexpr std::size_t most_grid_points = 1u << 18;

/// "X0,Y0,Z0,X1,Y1,Z1": the lower corner, then the upper one; none for "auto". Throws WrongUsage.
std::optional<ProbeBox> parse_box(const std::string& text);

}  // namespace kiln
