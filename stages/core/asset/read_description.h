// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "asset/fields.h"
#include "asset/prt_asset.h"

namespace kiln {

/// Keys at the start of every JSON file of the format.
struct FormatHead {
  int version = 0;                    ///< 0 if faulty
  std::vector<std::string> required;  ///< entries of `requires` that this reader knows
};

/// Reads the format, its version, what it requires (each of which must be among `known`) and the basis.
FormatHead read_head(const Fields& fields, const char* format, const std::vector<std::string>& known);

/// Reads "min" and "max".
PlaneRange read_range(const Fields& fields);

/// Reads the levels of detail under "levels", each coarser than the one before and for farther away; none where the key
/// is missing.
std::vector<PrtLevel> read_levels(const Fields& fields);

/// Reads `file`, ranges.json or pca.json, with all faults reported, and returns its description and its head. Faulty
/// parts are left out, or 0.
std::pair<PrtDescription, FormatHead> read_description(const std::filesystem::path& file, Faults& faults);

/// Lists what a reader must know beyond the base form, as `requires` states it.
std::vector<std::string> requirements(const PrtDescription& asset);

/// Suggests what to do about a fault of such a folder.
std::string remedy_for(const PrtDescription& asset);

/// Lists the files of a folder that its description names, each once: meshes, pictures, tables, further maps.
std::vector<std::string> named_files(const PrtDescription& asset);

/// Finds the file that describes a folder: pca.json or, without it, ranges.json. Throws BadInput if there is neither.
std::filesystem::path description_file(const std::filesystem::path& folder);

}  // namespace kiln
