// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/shade_settings.h"

#include <algorithm>

namespace kiln {

OptionSet shading_options(ShadingSettings& settings) {
  OptionSet options;
  options
      .choice(
          "way", settings.way,
          {{"factored", ShadingWay::factored}, {"deferred", ShadingWay::deferred}, {"forward", ShadingWay::forward}},
          "forward shades every surface as it is drawn; deferred what is visible, each shader by itself; factored "
          "does what shaders share once for all: the same picture")
      .choice("direct", settings.direct, {{"maps", DirectLightBy::maps}, {"transfer", DirectLightBy::transfer}},
              "How lights with a direction reach baked assets: maps is as other surfaces, by shadow maps; transfer as "
              "all other light, with the assets' own shadows and those of --shadows. Highlights are always shadowed by "
              "maps")
      .integer("samples", settings.samples, 1, 64, "Samples per pixel, averaged in linear radiance")
      .integer("shadow-size", settings.shadow_size, 16, 8192, "Texels on a side of a shadow map")
      .integer("reflection-size", settings.reflection_size, 16, 8192, "Texels on a side of the reflection map");
  return options;
}

OptionSet shade_options(ShadeSettings& settings) {
  return render_options(settings.picture)
      .without(
          {"technique", "space", "level", "side-by-side", "shading", "specular", "shininess", "supersample", "albedo"});
}

void settle_light(ShadeSettings& settings, const SceneDescription& scene, bool shadows_given) {
  const bool is_whole = settings.shading.direct == DirectLightBy::transfer;
  if (!shadows_given && !is_whole) settings.film.shadows = ShadowMethod::none;
  const bool is_local = is_whole && std::any_of(scene.lights.begin(), scene.lights.end(), [](const SceneLight& light) {
                          return light.spec.kind == LightSpec::Kind::sphere;
                        });
  settings.shading.incident_samples =
      incident_samples_of(settings.picture, is_local || settings.film.shadows != ShadowMethod::none);
}

}  // namespace kiln
