// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/part_names.h"

#include "base/file_names.h"
#include "import/text_lines.h"

namespace kiln {

std::int32_t PartNames::number_of(std::string_view name) {
  name = trimmed(name);
  if (name.empty()) return -1;
  const auto found = numbers_of_.find(name);
  if (found != numbers_of_.end()) return found->second;
  const auto number = static_cast<std::int32_t>(names_.size());
  numbers_of_.emplace(name, number);
  names_.push_back(text_of_path(std::string(name)));
  return number;
}

}  // namespace kiln
