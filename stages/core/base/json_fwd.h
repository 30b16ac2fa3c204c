// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace kiln {

/// JSON type of the whole tree: keys keep the order in which they were added. Declared here, for headers that name it;
/// base/json.h defines it, which takes half a second to compile.
using Json = nlohmann::ordered_json;

}  // namespace kiln
