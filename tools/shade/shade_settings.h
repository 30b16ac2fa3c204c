// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "base/options.h"
#include "render/render_settings.h"
#include "runtime/shading/shading_settings.h"

namespace kiln {

/// Settings of kiln-shade: of the shading, and of the picture those of kiln-render that have a meaning here.
struct ShadeSettings {
  ShadingSettings shading = {};
  RenderSettings picture = {};
  double time_seconds = 0;

  ShadeSettings() {
    picture.width = 640;
    picture.height = 512;
  }
};

OptionSet shade_options(ShadeSettings& settings);

/// Applies what the scene's file states of the picture, except what was given on the command line. Throws BadInput for
/// settings that there are none of, and for values that they refuse.
void apply_picture(const OptionSet& options, const std::map<std::string, std::string>& picture,
                   const std::filesystem::path& file, const std::function<bool(const std::string&)>& given);

}  // namespace kiln
