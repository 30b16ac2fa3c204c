// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/shade_settings.h"

#include "base/errors.h"

namespace kiln {

OptionSet shade_options(ShadeSettings& settings) {
  OptionSet options = render_options(settings.picture)
                          .without({"technique", "space", "level", "side-by-side", "incident-samples", "shading",
                                    "specular", "shininess", "frames", "supersample", "albedo"});
  options
      .choice(
          "way", settings.shading.way,
          {{"factored", ShadingWay::factored}, {"deferred", ShadingWay::deferred}, {"forward", ShadingWay::forward}},
          "forward shades every surface as it is drawn; deferred what is visible, each shader by itself; factored "
          "does what shaders share once for all: the same picture")
      .integer("samples", settings.shading.samples, 1, 64, "Samples per pixel, averaged in linear radiance")
      .integer("shadow-size", settings.shading.shadow_size, 16, 8192, "Texels on a side of a shadow map")
      .integer("reflection-size", settings.shading.reflection_size, 16, 8192, "Texels on a side of the reflection map")
      .number("time", settings.time_seconds, 0, 1e6, "What shaders know as time, seconds");
  return options;
}

void apply_picture(const OptionSet& options, const std::map<std::string, std::string>& picture,
                   const std::filesystem::path& file, const std::function<bool(const std::string&)>& given) {
  for (const auto& [name, text] : picture) {
    const Option* option = options.find(name);
    if (option == nullptr)
      throw BadInput(file.string(), "picture: the setting '" + name + "'", "an option of kiln-shade --help",
                     "correct its name");
    if (given(name)) continue;
    try {
      option->set(text);
    } catch (const WrongUsage& fault) {
      throw BadInput(file.string(), std::string("picture: ") + fault.what(), "a value of its range", "correct it");
    }
  }
}

}  // namespace kiln
