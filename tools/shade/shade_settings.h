// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/options.h"
#include "render/film/film_settings.h"
#include "render/render_settings.h"
#include "runtime/scene/scene_description.h"
#include "runtime/shading/shading_settings.h"

namespace kiln {

/// Settings of kiln-shade: of the shading, and of pictures and films those of kiln-render that have a meaning here.
struct ShadeSettings {
  ShadingSettings shading = {};
  RenderSettings picture = {};
  FilmSettings film = {};

  ShadeSettings() {
    picture.width = 640;
    picture.height = 512;
  }
};

/// Options of the picture. Those of the scene's time and shadows are film_options.
OptionSet shade_options(ShadeSettings& settings);

/// Options of the shading alone, which a window has as well.
OptionSet shading_options(ShadingSettings& settings);

/// Settles what depends on others: without `shadows_given`, nodes shadow each other's light by transfer only where all
/// light arrives by it; and how many points of a node have light of their own.
void settle_light(ShadeSettings& settings, const SceneDescription& scene, bool shadows_given);

}  // namespace kiln
