#pragma once

#include <string>

#include "base/options.h"

namespace kiln {

/// A metric's name for people: "found_by_nearest_point" is "found by nearest point"; the common ones have words of
/// their own. Keys here and below may have their stage before them, "compress.error".
std::string metric_label(const std::string& key);

/// A metric's value with its unit, chosen by its key: shares in percent, seconds, bytes, counts with thin spaces. HTML.
std::string metric_value(const std::string& key, const Json& value);

/// A number with `digits` significant digits, with a true minus.
std::string rounded(double value, int digits);

/// The text with the characters that HTML keeps for itself written as entities.
std::string escaped(const std::string& text);

/// A light as a caption: "from azimuth 45°, elevation 30°".
std::string light_label(const std::string& light);

}  // namespace kiln
