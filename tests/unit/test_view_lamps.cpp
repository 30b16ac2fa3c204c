// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "base/errors.h"
#include "prt_folders.h"
#include "render/output/picture.h"
#include "scratch.h"
#include "shapes.h"
#include "view/draw/asset_view.h"
#include "view/draw/screen.h"
#include "view/state/keys.h"
#include "view/state/view_lights.h"

namespace kiln {
namespace test_view_lamps {

GivenLights two_lights() {
  GivenLights given;
  given.specs = {parse_light_spec("0,20"), parse_light_spec("90,10")};
  return given;
}

TEST(ViewLights, TheSunGoesByTheHour) {
  GivenLights given = two_lights();
  given.lamps = {"F11", "A"};
  given.suns = {std::nullopt, parse_sun_hour("sun:2026-06-21T16:30Z@48.1,11.6")};
  ViewLimits limits;
  limits.lamps = 2;
  limits.has_suns = true;
  ViewState state;
  const ViewState home;
  state.light = given_choice(given, LightWindow::none);
  EXPECT_EQ(spectra_of(state.light, given), (std::vector<std::string>{"F11", "sun:2026-06-21T16:30Z@48.1,11.6"}));
  EXPECT_EQ(lights_of(state.light, given).specs[1].azimuth_degrees, 90);  // as given, until the hour changes
  for (const char key : {'t', 't', 'T', 't', 't', 't', 'k'}) press(state, limits, home, key);
  EXPECT_EQ(spectra_of(state.light, given), (std::vector<std::string>{"A", "sun:2026-06-21T17:30Z@48.1,11.6"}));
  const SunHour hour = parse_sun_hour("sun:2026-06-21T17:30Z@48.1,11.6");
  const LightSpec sun = lights_of(state.light, given).specs[1];
  EXPECT_NEAR(sun.azimuth_degrees, scene_azimuth(hour, sun_position(hour)), 1e-6);
  EXPECT_NEAR(sun.elevation_degrees, sun_position(hour).elevation_degrees, 1e-6);
  EXPECT_EQ(sun.color, given.specs[1].color);
  for (int k = 0; k < 12; ++k) press(state, limits, home, 't');
  EXPECT_EQ(lights_of(state.light, given).specs[1].color, (std::array<float, 3>{0, 0, 0}));  // by night
  EXPECT_EQ(spectra_of(state.light, given)[1], "A");
  EXPECT_NE(describe_sun(state.light, given).find("below the horizon"), std::string::npos);
  press(state, limits, home, 'k');
  EXPECT_EQ(state.light.lamp, 0);
  press(state, limits, home, 'K');
  EXPECT_EQ(state.light.lamp, 1);
  EXPECT_FALSE(press(state, limits, home, 'v').message.empty());  // no camera
  EXPECT_FALSE(press(state, {}, home, 't').message.empty());      // no sun
  EXPECT_FALSE(press(state, {}, home, 'k').message.empty());      // no lamp
  state.light.preset = LightPreset::hemisphere;
  const LightSpec sky = lights_of(state.light, given).specs[0];
  EXPECT_EQ(sky.color[0], sky.color[2]);  // colour is the lamp's
}

TEST(Screen, LampsChangeAsARenderHasThem) {
  const Scratch scratch;
  const auto context = test::software_context();
  const TriangleMesh mesh = shapes::cube_sphere(8);
  test::write_asset(scratch.folder(), mesh, test::unoccluded_stack(mesh, 48, 32, 3, 16));
  RenderSettings settings;
  settings.width = 120;
  settings.height = 80;
  settings.supersample = 1;
  ViewState state;
  state.orbit = home_orbit({});
  state.bands = 3;
  LightSettings lights;
  lights.lights = {"sun:2026-06-21T16:30Z@48.1,11.6", "-60,20"};
  lights.ambient = "0.1";
  LampSettings lamps;
  lamps.lamps = {"F11", "P1900"};
  ViewScene scene = load_view_scene({"sphere", scratch.folder(), {}}, lights, lamps);
  scene.forms.plain->normals_file.clear();
  scene.forms.plain->albedo = PrtAlbedo::of_picture("albedo.png");
  scene.forms.plain->albedo.picture = Image<std::uint8_t>(2, 1, 3);
  const std::array<std::uint8_t, 6> texels = {200, 40, 60, 60, 180, 90};
  std::ranges::copy(texels, scene.forms.plain->albedo.picture.values().begin());
  state.light = given_choice(scene.lights, LightWindow::hann);
  const ViewLimits limits = limits_of(scene);
  EXPECT_EQ(limits.lamps, 2);
  EXPECT_TRUE(limits.has_suns);
  AssetView asset(scene, settings, state);
  const ViewState home = state;
  Image<std::uint8_t> before;
  for (const std::string keys : {"", "k", "tttt", "T", "K."}) {  // at last a coefficient, which is by RGB
    for (const char key : keys) press(state, limits, home, key);
    if (keys == "K.") press(state, limits, home, 'p');
    Canvas canvas(settings.width, settings.height, 1);
    if (keys == "K.") {
      ViewState coefficient = state;
      coefficient.show = Show::coefficient;
      asset.draw(coefficient, camera_of(home.orbit, asset.shape(), 120, 80), canvas);
    }
    asset.draw(state, camera_of(home.orbit, asset.shape(), 120, 80), canvas);
    Screen screen;
    screen.resolve(canvas, {});
    const Image<std::uint8_t> picture = screen.picture();
    EXPECT_NE(picture.values(), before.values());
    before = picture;

    LightSettings then = lights;
    SunHour hour = parse_sun_hour(lights.lights[0]);
    hour.day += state.light.sun_hours / 24;
    then.lights[0] = to_text(hour);
    const PrtAsset& drawn = *scene.forms.plain;
    const LampScene made =
        SpectralAssets({&drawn}, lamps).under(then, {lamps.lamps[static_cast<std::size_t>(state.light.lamp)]}, 3);
    AssetRenderer renderer(drawn);
    renderer.set_colors(made.colors[0]);
    const Image<std::uint8_t> expected =
        picture_from_radiance(render_scene({{&renderer, {}, Technique::textured_prt}}, made.lights,
                                           views_of(settings, drawn.mesh.positions).front()),
                              {});
    int largest = 0;
    for (std::size_t k = 0; k < picture.values().size(); ++k)
      if (expected.values()[k | 3] != 0)
        largest = std::max(largest, std::abs(picture.values()[k] - expected.values()[k]));
    EXPECT_LE(largest, 1) << keys;
  }
  lamps.lamps = {"F11", "F99"};
  EXPECT_THROW(load_view_scene({"sphere", scratch.folder(), {}}, lights, lamps), WrongUsage);
}

}  // namespace test_view_lamps
}  // namespace kiln
