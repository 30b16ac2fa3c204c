// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/atlas_settings.h"

#include "base/errors.h"

namespace kiln {

OptionSet atlas_options(AtlasSettings& settings) {
  OptionSet options;
  options.extent("size", settings.size, 8, 16384, "Width and height of the atlas, texels")
      .number("texels-per-unit", settings.texels_per_unit, 0, 1e9,
              "Texels per unit of the mesh's length, in place of --size: the atlas is the smallest square found that "
              "holds the charts; 0: as many as fit")
      .choice<AtlasDensity>("density", settings.density,
                            {{"even", AtlasDensity::even}, {"transfer", AtlasDensity::transfer}},
                            "Scale of the charts: the same, or larger where transfer varies more, at an equal total")
      .choice<UvChoice>("uv", settings.uv,
                        {{"auto", UvChoice::automatic}, {"keep", UvChoice::keep}, {"new", UvChoice::make}},
                        "The atlas's uvs: those that the mesh has (keep), which are refused where they are no atlas; "
                        "new ones, beside which the mesh's stay for its textures; auto keeps them where they are one")
      .integer("gutter", settings.gutter, 0, 64, "Free texels between two charts, and at the atlas's border")
      .number("max-stretch", settings.max_stretch, 1.0001, 10,
              "L2 stretch that a chart may have; less gives more charts")
      .number("max-stretch-linf", settings.max_stretch_linf, 1.01, 100, "L-infinity stretch that a chart may have")
      .number("crease", settings.crease, 1, 180,
              "Degrees; where the surface bends more along a chart's border, the border stays")
      .integer("rotations", settings.rotations, 1, 360, "Angles that are tried for each chart when packing")
      .choice<AtlasQuality>("quality", settings.quality,
                            {{"standard", AtlasQuality::standard}, {"best", AtlasQuality::best}},
                            "Time for cutting and packing: seconds, or what it takes to make the most of the atlas");
  add_import_options(options, settings.import);
  return options;
}

void check_size_settings(const AtlasSettings& settings, bool size_given) {
  if (settings.texels_per_unit > 0 && size_given)
    throw WrongUsage("texels-per-unit: found --size as well; expected one of them");
  if (settings.texels_per_unit > 0 && settings.uv == UvChoice::keep)
    throw WrongUsage("texels-per-unit: found --uv keep; expected --size, which those uvs are checked at");
}

}  // namespace kiln
