// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/options.h"
#include "render/film/film_settings.h"
#include "render/render_settings.h"
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

/// Options of the picture and, apart, of the scene's time.
OptionSet shade_options(ShadeSettings& settings);
OptionSet shade_film_options(ShadeSettings& settings);

}  // namespace kiln
