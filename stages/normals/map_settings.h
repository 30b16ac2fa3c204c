// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "base/options.h"

namespace kiln {

/// Further maps that artists' materials use, of the high mesh in the texels of the atlas.
enum class MapKind {
  ambient_occlusion,
  bent_normal,
  thickness,
  curvature,
  height,
  position,
  material,
  roughness,
  metalness,
  emission,
  orm  ///< ambient occlusion, roughness and metalness in red, green and blue, as glTF has them
};
inline constexpr int map_kinds = 11;

enum class MapFormat { png8, png16, exr };

/// What shadows a texel in maps of rays.
enum class MapOccluders {
  all,  ///< the whole high mesh
  part  ///< the part that the texel is matched to by name, as if parts were apart
};

struct MapSettings {
  std::vector<MapKind> kinds;           ///< in the order of MapKind, each once
  MapFormat format = MapFormat::png16;  ///< except of those that are PNG of 8 bits always (is_picture)
  int directions = 1024;                ///< spread over the sphere, of rays
  MapOccluders occluders = MapOccluders::all;
};

/// Returns the name of a kind, as --maps and the record have it; with `_` for `-` it is the name of its file.
std::string map_name(MapKind kind);
std::string map_file(MapKind kind, MapFormat format);

/// Tells whether a kind is for eyes and engines alone, a PNG of 8 bits in any format: ids of materials, and orm.
bool is_picture(MapKind kind);

/// Parses "none", "all" or names separated by commas. Throws WrongUsage.
std::vector<MapKind> parse_map_kinds(const std::string& text);
std::string text_of(const std::vector<MapKind>& kinds);

void add_map_options(OptionSet& options, MapSettings& settings);

}  // namespace kiln
