// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/normals_settings.h"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "base/errors.h"

namespace kiln {

std::vector<std::pair<std::string, double>> parse_part_cages(const std::string& text) {
  std::vector<std::pair<std::string, double>> cages;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string entry = text.substr(begin, end - begin);
    const std::size_t equals = entry.rfind('=');
    double cage = 0;
    const char* const last = entry.data() + entry.size();
    if (equals != std::string::npos && equals > 0) {
      const auto [stop, error] = std::from_chars(entry.data() + equals + 1, last, cage);
      if (error != std::errc() || stop != last) cage = 0;
    }
    if (!(cage > 0 && cage <= 1))
      throw WrongUsage("part-cage: found '" + entry +
                       "'; expected NAME=CAGE, a cage above 0 to 1, and a comma between");
    cages.emplace_back(entry.substr(0, equals), cage);
    begin = end + 1;
  }
  return cages;
}

OptionSet normals_options(NormalsSettings& settings) {
  OptionSet options;
  options.choice<NormalSpace>("space", settings.space,
                              {{"object", NormalSpace::object}, {"tangent", NormalSpace::tangent}},
                              "Space of normal.png; tangent is MikkTSpace's, green along +v");
  options.extent(
      "size", settings.size, 0, 16384,
      "Width and height of the maps in texels; 0 is the size in atlas.json beside the atlas, or 512 without it");
  options.extent(
      "albedo-size", settings.albedo_size, 0, 16384,
      "Width and height of albedo.png in texels, where colours vary more than light; 0 is the size of the maps");
  options.extent("normal-size", settings.normal_size, 0, 16384,
                 "Width and height of the normal map that ships, in texels; 0 is the size of the maps, which the bake "
                 "takes its normals from");
  options.choice<int>("samples", settings.samples, {{"1", 1}, {"4", 4}, {"16", 16}, {"64", 64}},
                      "Points per texel that normals are averaged over");
  options.toggle(
      "fit", settings.fit,
      "With one sample: sharpens the map so that bilinear lookups between texels' centres are nearer to the high "
      "mesh, and those at the centres a little less near; more samples are fitted always");
  options.choice<SeamChoice>("seams", settings.seams, {{"equalise", SeamChoice::equalise}, {"keep", SeamChoice::keep}},
                             "Changes texels near seams so that lookups on both sides agree, or keeps them");
  options.number(
      "cage", settings.cage, 0, 1,
      "How far rays look for the high mesh, outwards and inwards, as a fraction of its bounding box's diagonal; "
      "0 is twice the Hausdorff distance in simplify.json beside the atlas, or twice a measured one without it");
  options.file(
      "cage-mesh", settings.cage_mesh,
      "A cage of your own instead: the low mesh of kiln-simplify --low again, the same faces in the same order, "
      "its vertices moved outwards; rays go from it to the low mesh and as far again behind that");
  options.choice<MatchChoice>("match", settings.match,
                              {{"nearest", MatchChoice::nearest}, {"names", MatchChoice::names}},
                              "What texels may stand for: any surface, or, for parts that must not meet, with a low "
                              "mesh of your own: part NAME_low stands for NAME_high alone");
  options.checked_text("part-cage", settings.part_cage, "NAME=CAGE,NAME=CAGE, cages above 0 to 1",
                       "With --match names: cages of single parts, in place of --cage", parse_part_cages);
  add_map_options(options, settings.maps);
  add_material_options(options, settings.material);
  add_import_options(options, settings.import);
  return options;
}

}  // namespace kiln
