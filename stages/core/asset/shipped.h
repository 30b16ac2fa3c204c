// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace kiln {

/// Parts of an asset's folder that its transfer does not need.
struct ShippedParts {
  int normal_bits = 16;                ///< bits of the normal map, 8 or 16; 0: no normal map
  bool all_maps = false;               ///< all further maps of the normals stage ship
  std::vector<std::string> maps = {};  ///< names of further maps that ship

  bool operator==(const ShippedParts&) const = default;
};

/// Name of the setting of the bake that says them.
inline constexpr const char* ship_setting = "ship";

/// What the parser takes, for help.
inline constexpr const char* ship_range = "normal=none|8|16, maps=none|all|NAME+NAME..., separated by a comma";

/// Parses such as "normal=8", or "normal=none,maps=ao+orm". Throws WrongUsage.
ShippedParts parse_shipped_parts(const std::string& text);
std::string text_of(const ShippedParts& parts);

/// Returns the bytes of what ships of an asset in a folder of kiln-bake or kiln-compress: all its files but the record,
/// which no runtime reads.
std::uint64_t shipped_bytes(const std::filesystem::path& folder);

}  // namespace kiln
