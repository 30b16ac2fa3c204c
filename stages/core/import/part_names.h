// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kiln {

/// Names of a file's parts, each once, in the order in which faces use them.
class PartNames {
 public:
  /// Returns the number of the part of that name, which is a new one where no face had it before; -1 where the name is
  /// empty. Bytes that are not UTF-8 are written \xNN (base/file_names.h).
  std::int32_t number_of(std::string_view name);

  std::vector<std::string> all() && { return std::move(names_); }

 private:
  std::vector<std::string> names_;
  std::map<std::string, std::int32_t, std::less<>> numbers_of_;
};

}  // namespace kiln
