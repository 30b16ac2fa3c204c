// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "import/source_mesh.h"

namespace kiln {

/// Fault of a statement, for a message.
struct MapFault {
  std::string found, expected;
};

/// Statement such as `map_Kd` of an MTL file: the name of a picture, and how it is looked up.
struct MapStatement {
  std::string keyword;                        ///< of the statement, for messages
  std::string name;                           ///< as written, without quotes
  std::optional<std::filesystem::path> file;  ///< nothing where there is no such file
  double scale[2] = {1, 1}, offset[2] = {0, 0};
  double base = 0, gain = 1;
  bool clamp = false;
  std::optional<MapFault> fault;

  /// Returns the picture; `file` is there. `place` is that of the statement.
  SourceTexture texture(const std::string& place) const;
};

/// Reads the text after a keyword such as `map_Kd`, which messages name: options, a name that may hold blanks or stand
/// in quotes, more options. Where the numbers of an option might also begin the name, the reading that names a file in
/// `folder` is taken.
MapStatement read_map_statement(const std::string& keyword, std::string_view text, const std::filesystem::path& folder);

}  // namespace kiln
