#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace kiln {

/// The one JSON type of the house: keys keep the order in which they were added.
using Json = nlohmann::ordered_json;

/// A value as JSON text, on one line where `indent` is -1; bytes of strings that are no UTF-8 become U+FFFD.
std::string json_text(const Json& value, int indent = -1);

}  // namespace kiln
