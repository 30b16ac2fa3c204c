// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/map_settings.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "base/errors.h"

namespace kiln {

namespace {

/// By MapKind.
constexpr std::array<const char*, map_kinds> names = {"ao",        "bent-normal", "thickness", "curvature",
                                                      "height",    "position",    "material",  "roughness",
                                                      "metalness", "emission",    "orm"};

std::string all_names() {
  std::string text;
  for (const char* name : names) text += std::string(text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

std::string map_name(MapKind kind) { return names.at(static_cast<std::size_t>(kind)); }

std::string map_file(MapKind kind, MapFormat format) {
  std::string name = map_name(kind);
  std::replace(name.begin(), name.end(), '-', '_');
  return name + (format == MapFormat::exr && !is_picture(kind) ? ".exr" : ".png");
}

bool is_picture(MapKind kind) { return kind == MapKind::material || kind == MapKind::orm; }

std::vector<MapKind> parse_map_kinds(const std::string& text) {
  std::array<bool, map_kinds> wanted{};
  if (text == "all") wanted.fill(true);
  std::istringstream words(text == "none" || text == "all" ? "" : text + ",");
  for (std::string word; std::getline(words, word, ',');) {
    const auto found = std::find(names.begin(), names.end(), word);
    if (found == names.end())
      throw WrongUsage("maps: found '" + word + "'; expected none, all or some of " + all_names());
    wanted[static_cast<std::size_t>(found - names.begin())] = true;
  }
  std::vector<MapKind> kinds;
  for (std::size_t k = 0; k < wanted.size(); ++k)
    if (wanted[k]) kinds.push_back(static_cast<MapKind>(k));
  return kinds;
}

std::string text_of(const std::vector<MapKind>& kinds) {
  if (kinds.empty()) return "none";
  std::string text;
  for (const MapKind kind : kinds) text += (text.empty() ? "" : ",") + map_name(kind);
  return text;
}

void add_map_options(OptionSet& options, MapSettings& settings) {
  options
      .typed<std::vector<MapKind>>("maps", settings.kinds, "none, all, or names separated by commas: " + all_names(),
                                   "Further maps of the high mesh, for materials", parse_map_kinds,
                                   [](const std::vector<MapKind>& kinds) { return text_of(kinds); })
      .choice<MapFormat>("map-format", settings.format,
                         {{"png8", MapFormat::png8}, {"png16", MapFormat::png16}, {"exr", MapFormat::exr}},
                         "Files of these maps; PNG holds values as shares of a range that normals.json has, EXR the "
                         "values themselves")
      .integer("map-directions", settings.directions, 16, 1'000'000,
               "Directions of rays over the sphere, for ao and bent-normal; thickness takes a quarter of them")
      .choice<MapOccluders>("map-occluders", settings.occluders,
                            {{"all", MapOccluders::all}, {"part", MapOccluders::part}},
                            "With --match names: what shadows a texel in ao, bent-normal and thickness, the whole high "
                            "mesh or its own part alone");
}

}  // namespace kiln
