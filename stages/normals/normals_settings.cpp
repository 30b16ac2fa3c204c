// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/normals_settings.h"

namespace kiln {

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
  add_map_options(options, settings.maps);
  add_material_options(options, settings.material);
  add_import_options(options, settings.import);
  return options;
}

}  // namespace kiln
