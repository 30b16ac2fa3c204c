// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "asset/fields.h"
#include "asset/prt_asset.h"

namespace kiln {

/// What every JSON of the format begins with.
struct FormatHead {
  int version = 0;                    ///< 0 where it is at fault
  std::vector<std::string> required;  ///< what is known of it
};

/// Reads the format, a version that is known, what it requires, which must be among `known`, and the basis.
FormatHead read_head(const Fields& fields, const char* format, const std::vector<std::string>& known);

/// "min" and "max".
PlaneRange read_range(const Fields& fields);

/// The description in `file`, ranges.json or pca.json, with all its faults told of, and what it begins with. What is at
/// fault in it is left out, or 0.
std::pair<PrtDescription, FormatHead> read_description(const std::filesystem::path& file, Faults& faults);

/// What a reader of the base form would get wrong, as `requires` has it.
std::vector<std::string> requirements(const PrtDescription& asset);

/// What to do about a fault of such a folder.
std::string remedy_for(const PrtDescription& asset);

/// The file that describes a folder: pca.json, or where there is none ranges.json. Throws BadInput where there is none.
std::filesystem::path description_file(const std::filesystem::path& folder);

}  // namespace kiln
