// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/film/film_lamps.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/errors.h"
#include "base/files.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

/// Names of the lamps of a scene's lights, with files by the paths from here.
std::vector<std::string> names_of(const SceneDescription& scene, const fs::path& folder,
                                  const StandardSpectra& standards) {
  std::vector<std::string> names;
  for (const SceneLight& light : scene.lights) {
    std::error_code error;
    // Not normalised, so that no file is taken for a name.
    if (const fs::path file = folder / light.lamp; fs::is_regular_file(file, error)) {
      names.push_back(file.string());
      continue;
    }
    const auto refuse = [&] {
      throw BadInput(light.where, "the lamp '" + light.lamp + "'",
                     "A to E or F1 to F12 of the CIE, D50 or D5600 for daylight, P2856 for a black body, sun:20 for "
                     "the sun, or a file of a spectrum, relative to the scene's folder",
                     "change the line");
    };
    if (fs::is_regular_file(light.lamp, error)) refuse();  // relative to another folder
    try {
      standards.light(light.lamp);
    } catch (const WrongUsage&) {
      refuse();
    }
    names.push_back(light.lamp);
  }
  return names;
}

/// Throws BadInput for a light that has a colour at some time.
void require_one_radiance(const SceneDescription& scene) {
  const auto is_grey = [](const std::array<float, 3>& c) { return c[0] == c[1] && c[1] == c[2]; };
  for (const SceneLight& light : scene.lights) {
    bool is_good = is_grey(light.spec.color) && is_grey(light.spec.ground);
    if (const auto* keyframes = std::get_if<LightKeyframes>(&light.motion))
      for (const LightKeyframe& frame : keyframes->frames)
        is_good = is_good && (!frame.radiance || is_grey(*frame.radiance));
    if (!is_good)
      throw BadInput(light.where, "a light of a colour with a lamp", "one number as its radiance",
                     "leave the colour to the lamp, whose spectrum it is");
  }
}

/// Throws an error of an asset's again, with the line of the first node that has it.
[[noreturn]] void refuse_at_node(const Film& film, const BadInput& error) {
  for (const SceneItem& item : film.description.items)
    if (item.asset >= 0 && film.assets[static_cast<std::size_t>(item.asset)].ranges_file.string() == error.file())
      throw BadInput(item.where, "node '" + item.name + "', whose asset (" + error.file() + ") " + error.found(),
                     error.expected(), error.remedy());
  throw error;
}

}  // namespace

void light_by_lamps(Film& film, const fs::path& scene_file, const LampSettings& settings, const RenderSettings& look) {
  const SceneDescription& scene = film.description;
  const bool has_lamps = std::ranges::any_of(scene.lights, [](const SceneLight& light) { return !light.lamp.empty(); });
  if (!has_lamps && !are_spectral({}, settings)) return;
  if (settings.lamps.size() > 1)
    throw WrongUsage("lamp: found " + std::to_string(settings.lamps.size()) +
                     " beside a scene; expected one for all of its lights, or 'lamp' of each in the scene");
  if (!scene.environment.empty())
    throw WrongUsage("lamp: found the environment " + scene.environment.string() +
                     " in the scene, which is red, green and blue; expected lights alone");
  require_grey(look);
  require_one_radiance(scene);

  const std::vector<std::string> names =
      settings.lamps.empty() ? names_of(scene, folder_of(scene_file), StandardSpectra(settings.standards))
                             : std::vector<std::string>(scene.lights.size(), settings.lamps.front());
  SceneLights lights;
  lights.window = scene.window;
  for (const SceneLight& light : scene.lights) lights.specs.push_back(light.spec);
  try {
    film.lamps = SpectralAssets(film.asset_pointers(), settings).under(std::move(lights), names);
  } catch (const BadInput& error) {
    refuse_at_node(film, error);
  }
}

}  // namespace kiln
