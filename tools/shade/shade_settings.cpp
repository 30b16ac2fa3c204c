// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/shade_settings.h"

namespace kiln {

OptionSet shade_options(ShadeSettings& settings) {
  OptionSet options = render_options(settings.picture)
                          .without({"technique", "space", "level", "side-by-side", "incident-samples", "shading",
                                    "specular", "shininess", "supersample", "albedo"});
  options
      .choice(
          "way", settings.shading.way,
          {{"factored", ShadingWay::factored}, {"deferred", ShadingWay::deferred}, {"forward", ShadingWay::forward}},
          "forward shades every surface as it is drawn; deferred what is visible, each shader by itself; factored "
          "does what shaders share once for all: the same picture")
      .integer("samples", settings.shading.samples, 1, 64, "Samples per pixel, averaged in linear radiance")
      .integer("shadow-size", settings.shading.shadow_size, 16, 8192, "Texels on a side of a shadow map")
      .integer("reflection-size", settings.shading.reflection_size, 16, 8192, "Texels on a side of the reflection map");
  return options;
}

OptionSet shade_film_options(ShadeSettings& settings) {
  return film_options(settings.film).without({"shadows", "shadow-directions", "shadow-backend", "shadow-texels"});
}

}  // namespace kiln
