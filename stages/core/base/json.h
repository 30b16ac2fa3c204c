// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "base/json_fwd.h"

namespace kiln {

/// Writes a value as JSON text, on one line where `indent` is -1. Bytes of strings that are not UTF-8 become U+FFFD.
std::string json_text(const Json& value, int indent = -1);

}  // namespace kiln
