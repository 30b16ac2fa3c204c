#include "normals/normals_settings.h"

namespace kiln {

OptionSet normals_options(NormalsSettings& settings) {
  OptionSet options;
  options.choice<NormalSpace>("space", settings.space,
                              {{"object", NormalSpace::object}, {"tangent", NormalSpace::tangent}},
                              "Space of normal.png; tangent is MikkTSpace's, green along +v");
  options.integer(
      "size", settings.size, 0, 16384,
      "Texels along each side of the maps; 0 is the size in atlas.json beside the atlas, or 512 without it");
  options.number(
      "cage", settings.cage, 0, 1,
      "How far rays look for the high mesh, outwards and inwards, as a fraction of its bounding box's diagonal; "
      "0 is twice the Hausdorff distance in simplify.json beside the atlas, or twice a measured one without it");
  return options;
}

}  // namespace kiln
