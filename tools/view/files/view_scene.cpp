// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/files/view_scene.h"

#include "lights/suns.h"

namespace kiln {

namespace {

/// Notes the suns of lights by spectra, and the lamps of the others. Throws, before there is a window, as each of the
/// lamps would.
void note_spectra(ViewScene& scene, const LightSettings& lights, const LampSettings& lamps) {
  scene.lamps = lamps;
  scene.lights.lamps = lamps.lamps.empty() ? std::vector<std::string>{"D65"} : lamps.lamps;
  scene.lights.suns.resize(scene.lights.specs.size());
  for (std::size_t k = 0; k < lights.lights.size(); ++k)
    if (is_sun_hour(lights.lights[k])) scene.lights.suns[k] = parse_sun_hour(lights.lights[k]);
  const SpectralAssets all(assets_of(scene.forms), lamps);
  LampSettings of_no_asset = lamps;
  of_no_asset.reflectances.clear();
  const SpectralAssets none({}, of_no_asset);
  for (const std::string& lamp : scene.lights.lamps) none.under(lights, {lamp}, 1);
}

}  // namespace

std::vector<const PrtAsset*> assets_of(const AssetForms& forms) {
  std::vector<const PrtAsset*> assets;
  for (const std::optional<PrtAsset>* form : {&forms.plain, &forms.compressed})
    if (*form) assets.push_back(&**form);
  return assets;
}

ViewScene load_view_scene(const AssetFolders& folders, const LightSettings& light_settings, const LampSettings& lamps) {
  ViewScene scene{load_asset_forms(folders), {}, {}};
  SceneLights lights = scene_lights(with_placed_suns(light_settings), scene.forms.main().bands);
  scene.lights = {std::move(lights.specs), std::move(lights.environment), bounding_box(scene.forms.main().mesh)};
  if (are_spectral(light_settings, lamps)) note_spectra(scene, light_settings, lamps);
  return scene;
}

ViewLimits limits_of(const ViewScene& scene) {
  ViewLimits limits = limits_of(scene.forms);
  limits.has_environment = scene.lights.environment.has_value();
  limits.lamps = static_cast<int>(scene.lights.lamps.size());
  limits.has_suns = !describe_sun({}, scene.lights).empty();
  limits.has_camera = !scene.lamps.sensor.empty();
  return limits;
}

}  // namespace kiln
