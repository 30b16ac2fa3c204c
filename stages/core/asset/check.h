// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/errors.h"

namespace kiln {

/// A folder of the asset format, and what is wrong with it.
struct CheckedFolder {
  std::filesystem::path folder;
  std::string format;            ///< "kiln-prt", "kiln-prt-pca" or "kiln-probes"; empty: there is none of them
  int version = 0;               ///< of the format; 0: not known
  std::vector<BadInput> faults;  ///< all of them; of a file that is damaged the first
};

/// Checks all that docs/format.md asks for: of `folder`, or where it is no folder of the format itself of those in it
/// that are, by name, as of an asset's folder with prt/ and small/. There is at least one.
std::vector<CheckedFolder> check_folder(const std::filesystem::path& folder);

}  // namespace kiln
