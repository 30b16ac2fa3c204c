#include "atlas/atlas_settings.h"

namespace kiln {

OptionSet atlas_options(AtlasSettings& settings) {
  OptionSet options;
  options.integer("size", settings.size, 16, 8192, "Width and height of the atlas, texels")
      .integer("gutter", settings.gutter, 0, 64, "Free texels between two charts, and at the atlas's border")
      .number("max-stretch", settings.max_stretch, 1.0001, 10,
              "L2 stretch that a chart may have; less gives more charts")
      .number("max-stretch-linf", settings.max_stretch_linf, 1.01, 100, "L-infinity stretch that a chart may have")
      .number("crease", settings.crease, 1, 180,
              "Degrees; where the surface bends more along a chart's border, the border stays")
      .integer("rotations", settings.rotations, 1, 360, "Angles that are tried for each chart when packing");
  return options;
}

}  // namespace kiln
