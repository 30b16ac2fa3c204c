// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "base/options.h"

namespace kiln {

/// Number of times that light bounces.
struct BounceTarget {
  bool automatic = false;  ///< stop when a further bounce would add too little; each stage says how much that is
  int count = 0;           ///< fixed number of bounces; ignored if `automatic`

  bool any() const { return automatic || count > 0; }

  /// Returns the largest number of bounces to take.
  int most() const;

  bool operator==(const BounceTarget&) const = default;
};

/// Largest number of bounces. With an albedo of 0.8 throughout, the hundredth bounce in a closed room is a 5-billionth
/// of the direct light.
inline constexpr int most_bounces = 100;

inline int BounceTarget::most() const { return automatic ? most_bounces : count; }

/// Parses --bounces: "auto" or a number of 0 to most_bounces. Throws WrongUsage.
BounceTarget parse_bounces(const std::string& text);

/// Adds the option --bounces.
OptionSet& add_bounces_option(OptionSet& options, BounceTarget& bounces, const std::string& help);

}  // namespace kiln
