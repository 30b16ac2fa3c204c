#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "import/source_mesh.h"

namespace kiln {

/// What is wrong with a statement, for a message.
struct MapFault {
  std::string found, expected;
};

/// A `map_Kd` statement of an MTL file: what a picture is called, and how it is looked up.
struct MapStatement {
  std::string name;                           ///< as it stands, without quotes
  std::optional<std::filesystem::path> file;  ///< nothing where there is no such file
  double scale[2] = {1, 1}, offset[2] = {0, 0};
  double base = 0, gain = 1;
  bool clamp = false;
  std::optional<MapFault> fault;

  void apply_to(SourceMaterial& material) const;
};

/// Reads what follows `map_Kd`: options, a name that may hold blanks or stand in quotes, options. Where numbers of an
/// option may as well begin the name, that which names a file in `folder` is taken.
MapStatement read_map_statement(std::string_view text, const std::filesystem::path& folder);

}  // namespace kiln
