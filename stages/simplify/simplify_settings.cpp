#include "simplify/simplify_settings.h"

namespace kiln {

OptionSet simplify_options(SimplifySettings& settings) {
  OptionSet options;
  options.integer("faces", settings.faces, 4, 100'000'000, "Triangles to stop at");
  options.number(
      "max-error", settings.max_error, 0, 1,
      "Instead of --faces: keep within this Hausdorff distance of the input, a fraction of the bounding box's "
      "diagonal, from 0.0001; 0 is by --faces");
  options.choice<SimplifyQuality>(
      "quality", settings.quality,
      {{"draft", SimplifyQuality::draft}, {"standard", SimplifyQuality::standard}, {"best", SimplifyQuality::best}},
      "What is paid for the result: draft is the quickest, standard is nearer to the input, best is fitted to it for "
      "seconds to minutes");
  options.choice<SimplifyAwareness>(
      "aware", settings.aware, {{"none", SimplifyAwareness::none}, {"transfer", SimplifyAwareness::transfer}},
      "transfer: more triangles where self-shadowing varies, at equal count, fewer elsewhere");
  options.number("crease", settings.crease, 0, 180,
                 "Edges whose dihedral angle exceeds this stay lines, degrees; 0 is none");
  options.toggle("strict", settings.strict, "Refuse an input that needs repair instead of repairing it");
  add_import_options(options, settings.import);
  options.toggle("colors", settings.colors, "Keep the input's colours, as colours of vertices");
  return options;
}

}  // namespace kiln
