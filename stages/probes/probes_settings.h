#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "base/options.h"
#include "sh/directions.h"

namespace kiln {

struct ProbesSettings {
  std::string grid = "8x8x8";  ///< points along x, y and z
  std::string box = "auto";    ///< of the grid, object units: X0,Y0,Z0,X1,Y1,Z1
  int bands = 5;               ///< of the light far away and of the light that comes in
  int directions = 1024;       ///< that a point looks into
  Sampling sampling = Sampling::fibonacci;
};

OptionSet probes_options(ProbesSettings& settings);

/// "NxMxK". Throws WrongUsage.
std::array<int, 3> parse_grid(const std::string& text);
inline constexpr std::size_t most_grid_points = 1u << 18;

/// "X0,Y0,Z0,X1,Y1,Z1": the lower corner, then the upper one; none for "auto". Throws WrongUsage.
std::optional<std::array<float, 6>> parse_box(const std::string& text);

}  // namespace kiln
