// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>

#include "base/options.h"

namespace kiln {

/// Framing of a camera, beside where it stands.
struct FramingSettings {
  double zoom = 1;                ///< magnifies the middle of the picture
  std::string target = "auto";    ///< "X,Y,Z", object units, in the middle of the picture
  std::string distance = "auto";  ///< distance of the camera from the target, object units

  /// Returns the target; none for auto. Throws WrongUsage.
  std::optional<std::array<double, 3>> target_place() const;

  /// Returns the distance; 0 for auto. Throws WrongUsage.
  double target_distance() const;
};

/// Adds `zoom`, `target` and `distance`.
void add_framing_options(OptionSet& options, FramingSettings& settings);

}  // namespace kiln
