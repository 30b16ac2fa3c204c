// SPDX-License-Identifier: MIT
#include "base/json.h"

namespace kiln {

std::string json_text(const Json& value, int indent) {
  return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace kiln
