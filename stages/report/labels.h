// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "base/json_fwd.h"

namespace kiln {

/// Returns a metric's name for people: "found_by_nearest_point" becomes "found by nearest point"; common metrics have
/// names of their own. Keys here and below may be preceded by their stage, "compress.error".
std::string metric_label(const std::string& key);

/// Direction in which a metric gets better.
enum class Better { neither, lower, higher };

/// Returns the direction of a metric; `neither` for facts, such as a number of triangles, and for unknown ones.
Better better_direction(const std::string& key);

/// Tells whether a metric is a time or a speed or an amount of memory, which depends on the machine and its other work.
bool is_machine_cost(const std::string& key);

/// Formats a metric's value with its unit, chosen by its key: shares in percent, seconds, bytes, counts with thin
/// spaces. HTML.
std::string metric_value(const std::string& key, const Json& value);

/// Formats a number with `digits` significant digits, and with a minus sign.
std::string rounded(double value, int digits);

/// Formats a whole number with its digits in groups of three, between narrow no-break spaces, and with a minus sign.
std::string grouped(long long value);

/// Describes a light: "from azimuth 45°, elevation 30°".
std::string light_label(const std::string& light);

}  // namespace kiln
