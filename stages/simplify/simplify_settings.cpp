#include "simplify/simplify_settings.h"

namespace kiln {

OptionSet simplify_options(SimplifySettings& settings) {
  OptionSet options;
  options.integer("faces", settings.faces, 4, 100'000'000, "Triangles to stop at");
  options.number(
      "max-error", settings.max_error, 0, 1,
      "Instead of --faces: keep within this Hausdorff distance of the input, a fraction of the bounding box's "
      "diagonal, from 0.0001; 0 is by --faces");
  options.choice<CollapseCost>("cost", settings.cost,
                               {{"lindstrom-turk", CollapseCost::lindstrom_turk},
                                {"plane", CollapseCost::plane},
                                {"probabilistic-triangle", CollapseCost::probabilistic_triangle}},
                               "Cost of a collapse; the last two are Garland-Heckbert quadrics");
  return options;
}

}  // namespace kiln
