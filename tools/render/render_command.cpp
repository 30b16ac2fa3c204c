// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/render_command.h"

#include <algorithm>
#include <string>

#include "base/command_line.h"
#include "base/errors.h"
#include "lights/light_command.h"
#include "render/lamps.h"
#include "render/output/picture.h"

namespace kiln {

void RenderCommand::add_to(CommandLine& command) {
  command.inputs("INPUT", paths.assets,
                 "Output folders of kiln-bake or kiln-compress, nothing else of which is read; or a scene.yaml");
  command.optional_output(output, "The picture: .png, or .exr for linear float radiance as it is");
  command.input_option("compressed", paths.compressed,
                       "The asset as kiln-compress made it, for --technique compressed");
  command.list_option("place", paths.places, "Picture",
                      "Where an asset stands, once for each in their order: X,Y,Z[,AZIMUTH[,SCALE]], degrees about "
                      "+Y (default: the first where it is, the others side by side to its right as the camera sees "
                      "them, on its ground line, a tenth of their width apart)");
  add_light_options(command, lights, paths.light_file);
  command.flag("each-light", paths.each_light, "Light",
               "A picture for each light, NAME_000.png and so on, in place of one under all; ambient light and an "
               "environment are in every picture");
  command.flag("each-asset", paths.each_asset, "Picture",
               "A picture for each asset by itself, where it was baked, NAME_000.png and so on, in place of one of "
               "all; with --each-light all lights of the first asset, then of the next");
  command.input_option("probes", paths.probes,
                       "Folder of kiln-probes: the light around the first asset, which stands at the origin, for the "
                       "others; for the only asset, that around what is not drawn");
  add_lamp_options(command, paths.lamps,
                   "Spectrum of all lights, those of a scene as well, or of each --light in turn");
  command.options("Picture", render_options(settings));
  command.options("Scene", film_options(film));
  command.flag("tree", tree, "Scene", "Print the tree that shadows go by at --time, and draw nothing");
}

void RenderCommand::check(const CommandLine& command) const {
  const auto require = [](bool good, const std::string& message) {
    if (!good) throw WrongUsage(message);
  };
  if (is_film()) {
    for (const char* option : {"light", "ambient", "environment", "environment-rotation", "light-file", "window"})
      require(!command.given(option), std::string(option) + ": found it beside a scene; expected lights in the scene");
    for (const char* option : {"place", "probes", "compressed", "each-light", "each-asset"})
      require(!command.given(option), std::string(option) + ": found it beside a scene; expected assets alone");
    require(!is_sheet(settings) && settings.space == PictureSpace::camera,
            "technique all, side-by-side and space: found one with a scene; expected a picture of the whole scene");
    check_shadow_backend(film);
  } else {
    const auto is_scene = [](const std::filesystem::path& path) { return is_scene_file(path); };
    require(std::none_of(paths.assets.begin(), paths.assets.end(), is_scene),
            "found a scene beside other inputs; expected one scene, or assets");
    for (const char* option :
         {"time", "fps", "shadows", "shadow-directions", "shadow-backend", "shadow-texels", "strip", "tree"})
      require(!command.given(option), std::string(option) + ": found it without a scene; expected a scene.yaml");
  }
  picture_of(settings);
  if (tree) return;
  require(!output.empty(), "--output is required");
  if (is_sheet(settings) && output.extension() != ".png")
    throw WrongUsage("output: found '" + output.string() + "'; expected a name that ends in .png for a sheet");
  require_picture_name(output);
}

}  // namespace kiln
