// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/errors.h"

namespace kiln {

/// One folder of the asset format, and its faults.
struct CheckedFolder {
  std::filesystem::path folder;
  std::string format;            ///< "kiln-prt", "kiln-prt-pca" or "kiln-probes"; empty if the folder has none of these
  int version = 0;               ///< version of the format; 0 if unknown
  std::vector<BadInput> faults;  ///< all faults; for a damaged file only the first
};

/// Checks `folder` against docs/format.md. A folder that has no description of its own, such as an asset's folder with
/// prt/ and small/, stands for the folders in it that have one, sorted by name. Returns at least one result.
std::vector<CheckedFolder> check_folder(const std::filesystem::path& folder);

}  // namespace kiln
