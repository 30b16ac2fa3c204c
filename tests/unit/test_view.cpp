// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <numbers>
#include <set>

#include "base/errors.h"
#include "prt_folders.h"
#include "render/output/picture.h"
#include "runtime/decode/plane_weights.h"
#include "scratch.h"
#include "sh/directions.h"
#include "shapes.h"
#include "view/draw/asset_view.h"
#include "view/draw/panel.h"
#include "view/draw/screen.h"
#include "view/files/file_watch.h"
#include "view/files/view_scene.h"
#include "view/state/keys.h"
#include "view/state/orbit.h"
#include "view/state/script.h"
#include "view/state/view_lights.h"

namespace kiln {
namespace {

using namespace test;
namespace fs = std::filesystem;

const TriangleMesh sphere = shapes::cube_sphere(4);
const std::vector<Eigen::Vector3f>& shape = sphere.positions;
const BoundingBox box = bounding_box(sphere);

// ---- the camera ----

TEST(Orbit, HomeIsTheCameraOfARender) {
  CameraSettings home;
  home.azimuth_degrees = -130;
  home.elevation_degrees = 41;
  const Camera expected = make_camera(shape, home, 320, 200), camera = camera_of(home_orbit(home), shape, 320, 200);
  EXPECT_EQ(camera.clip_from_object(), expected.clip_from_object());
}

TEST(Orbit, TurningKeepsTheDistanceAndGoesAround) {
  Orbit orbit = home_orbit({});
  const Eigen::Vector3f target = camera_of(orbit, shape, 320, 200).target.cast<float>();
  const auto distance = [&] { return (camera_of(orbit, shape, 320, 200).position - target).norm(); };
  const float at_home = distance();
  for (int k = 0; k < 9; ++k) {
    turn_orbit(orbit, 100, 0);
    EXPECT_NEAR(distance(), at_home, 1e-5f * at_home);
  }
  EXPECT_NEAR(orbit.azimuth_degrees, 20, 1e-9) << "900 pixels of 0.4 degrees are a turn";
  turn_orbit(orbit, 0, 1e6);
  EXPECT_EQ(orbit.elevation_degrees, 90);
  EXPECT_TRUE(camera_of(orbit, shape, 320, 200).clip_from_object().allFinite());
}

TEST(Orbit, PanningMovesThePointLookedAtWithThePointer) {
  Orbit orbit = home_orbit({});
  turn_orbit(orbit, 70, 30);
  zoom_orbit(orbit, 3);
  const Eigen::Vector4f target = camera_of(orbit, shape, 320, 200).target.cast<float>().homogeneous();
  pan_orbit(orbit, shape, 24, -15, 320, 200);
  const Eigen::Vector4f clip = camera_of(orbit, shape, 320, 200).clip_from_object() * target;
  // Measure from the middle of the picture, in pixels; clip space is 2 wide and high.
  EXPECT_NEAR(clip.x() / clip.w() * 160, 24, 0.01);
  EXPECT_NEAR(clip.y() / clip.w() * 100, 15, 0.01);
}

TEST(Orbit, WhatIsSeenIsBetweenNearAndFar) {
  Orbit orbit = home_orbit({});
  for (const double steps : {-100.0, -5.0, 0.0, 5.0, 100.0}) {
    orbit.zoom = 1;
    zoom_orbit(orbit, steps);
    const Camera camera = camera_of(orbit, shape, 320, 200);
    EXPECT_GT(camera.near_distance, 0);
    for (const Eigen::Vector3f& vertex : shape) {
      const float depth = (vertex - camera.position).dot(camera.forward);
      EXPECT_GE(camera.far_distance, depth);
      EXPECT_TRUE(depth < 0 || camera.near_distance <= depth || camera.near_distance < 0.01f * box.diagonal());
    }
  }
}

// ---- keys ----

ViewLimits all_limits() {
  ViewLimits limits;
  limits.techniques.assign(all_techniques.begin(), all_techniques.end());
  limits.bands = 4;
  limits.channels = 3;
  limits.has_reference = limits.has_charts = limits.has_environment = true;
  return limits;
}

TEST(Keys, DoWhatTheHelpSays) {
  const ViewLimits limits = all_limits();
  ViewState home;
  home.bands = 4;
  ViewState state = home;
  const auto type = [&](const std::string& keys) {
    for (const char key : keys) EXPECT_EQ(press(state, limits, home, key).message, "") << key;
  };
  for (std::size_t k = 0; k < 5; ++k) {
    type(std::string(1, static_cast<char>('1' + k)));
    EXPECT_EQ(state.technique, all_techniques[k]);
  }
  type("f");
  EXPECT_EQ(state.shading, Shading::deferred);
  type("llL");
  EXPECT_EQ(state.light.preset, LightPreset::directional);
  type("w");
  EXPECT_EQ(state.light.window, LightWindow::lanczos);
  type("[[[[[");
  EXPECT_EQ(state.bands, 1);
  type("]]]]]");
  EXPECT_EQ(state.bands, 4);
  type(".,");
  EXPECT_EQ(state.show, Show::coefficient);
  EXPECT_EQ(state.coefficient, 47) << "the one before the first is the last: 3 channels of 16";
  type("n");
  EXPECT_EQ(state.show, Show::normals);
  type("n");
  EXPECT_EQ(state.show, Show::picture);
  type("c");
  EXPECT_EQ(state.show, Show::charts);
  type("d+");
  EXPECT_EQ(state.show, Show::difference);
  EXPECT_EQ(state.difference_gain, 16);
  type("p+");
  EXPECT_EQ(state.show, Show::picture);
  EXPECT_EQ(state.exposure_stops, 0.5);
  type("mihe");
  EXPECT_TRUE(state.mesh && !state.readout && state.help && state.light.environment);
  type("r");
  EXPECT_EQ(state.technique, home.technique);
  EXPECT_EQ(state.light, home.light);
  EXPECT_FALSE(state.mesh);
  EXPECT_EQ(press(state, limits, home, 's').wish, Wish::screenshot);
  EXPECT_EQ(press(state, limits, home, 'q').wish, Wish::close);
  EXPECT_EQ(press(state, limits, home, escape_key).wish, Wish::close);
}

TEST(Keys, SayWhyNothingHappens) {
  ViewLimits limits;
  limits.techniques = {Technique::vertex_prt};
  ViewState home;
  home.technique = Technique::vertex_prt;
  ViewState state = home;
  for (const char key : std::string("1245dce")) {
    EXPECT_NE(press(state, limits, home, key).message, "") << key;
    EXPECT_EQ(state.technique, Technique::vertex_prt);
    EXPECT_EQ(state.show, Show::picture);
    EXPECT_FALSE(state.light.environment);
  }
}

TEST(Keys, AKeyStandsForOneThing) {
  std::set<char> seen;
  for (const auto& [keys, does] : key_help())
    if (keys.size() == 1) {
      EXPECT_TRUE(seen.insert(keys.front()).second) << keys;
      EXPECT_EQ(key_named(keys), keys.front());
      EXPECT_NE(key_help_text().find(does), std::string::npos);
    }
  EXPECT_EQ(key_named("escape"), escape_key);
  EXPECT_EQ(key_named("z"), 0);
  EXPECT_EQ(key_named("fl"), 0);
}

TEST(ViewState, IsBroughtWithinLimits) {
  ViewLimits limits;
  limits.techniques = {Technique::phong};
  limits.bands = 2;
  ViewState state;
  state.bands = 5;
  state.coefficient = 24;
  state.show = Show::difference;
  state.light.environment = true;
  limit(state, limits);
  EXPECT_EQ(state.technique, Technique::phong);
  EXPECT_EQ(state.bands, 2);
  EXPECT_EQ(state.coefficient, 3);
  EXPECT_EQ(state.show, Show::picture);
  EXPECT_FALSE(state.light.environment);
}

// ---- lights ----

GivenLights given_lights(const std::vector<std::string>& texts) {
  GivenLights given;
  for (const std::string& text : texts) given.specs.push_back(parse_light_spec(text));
  given.box = box;
  return given;
}

TEST(ViewLights, NothingMovesBeforeItIsDragged) {
  const GivenLights given = given_lights({"ambient:0.1", "sphere:1,2,3,0.5,1,0.5,0.2", "-60,20"});
  const LightChoice choice = given_choice(given, LightWindow::none);
  EXPECT_NEAR(choice.azimuth_degrees, std::atan2(1, 3) * 180 / std::numbers::pi, 1e-5);
  const SceneLights lights = lights_of(choice, given);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(to_text(lights.specs[k]), to_text(given.specs[k]));
}

TEST(ViewLights, TheMainLightIsDragged) {
  const GivenLights given = given_lights({"ambient:0.1", "-60,20,1,0.5,0.2", "10,10"});
  LightChoice choice = given_choice(given, LightWindow::none);
  ViewState state;
  state.light = choice;
  drag(state, Drag::light, 50, -25, shape, 320, 200);
  const SceneLights lights = lights_of(state.light, given);
  EXPECT_NEAR(lights.specs[1].azimuth_degrees, -40, 1e-9);
  EXPECT_NEAR(lights.specs[1].elevation_degrees, 30, 1e-9);
  EXPECT_EQ(lights.specs[1].color, given.specs[1].color);
  EXPECT_EQ(to_text(lights.specs[2]), to_text(given.specs[2]));
}

/// Computes the exit radiance of a white surface at `place` that faces `direction`, by enough harmonics for a cosine.
double facing_radiance(const LightSpec& spec, const Eigen::Vector3f& place, const Eigen::Vector3f& direction) {
  const LightCoefficients light = irradiance(light_coefficients(spec, 24, place.cast<double>()));
  return evaluate_at(light.channels[0], direction) / std::numbers::pi;
}

TEST(ViewLights, ABallGoesAroundTheAssetWithoutChange) {
  GivenLights given = given_lights({"sphere:3,1,2,0.4,5,5,5"});
  given.box.highest += Eigen::Vector3f(1, 0, 0.5f);  // so that its centre is not the origin
  const LightChoice before = given_choice(given, LightWindow::none);
  LightChoice after = before;
  after.azimuth_degrees += 70;
  after.elevation_degrees = -20;
  const auto at_centre = [&](const LightChoice& choice) {
    return facing_radiance(lights_of(choice, given).specs[0], given.box.centre(),
                           direction_from_angles(choice.azimuth_degrees, choice.elevation_degrees));
  };
  EXPECT_NEAR(at_centre(after), at_centre(before), 1e-3 * at_centre(before));
}

TEST(ViewLights, PresetsLightTheAssetAlike) {
  GivenLights given = given_lights({"0,0"});
  given.box.lowest += Eigen::Vector3f(4, 0, 0);
  given.box.highest += Eigen::Vector3f(4, 0, 0);
  LightChoice choice;
  choice.window = LightWindow::none;
  const Eigen::Vector3f towards = direction_from_angles(choice.azimuth_degrees, choice.elevation_degrees);
  for (const LightPreset preset : {LightPreset::directional, LightPreset::ball, LightPreset::ambient}) {
    choice.preset = preset;
    const LightSpec spec = lights_of(choice, given).specs[0];
    EXPECT_NEAR(facing_radiance(spec, given.box.centre(), towards), 1, 0.01) << to_text(spec);
  }
}

TEST(ViewLights, AnEnvironmentAloneIsTurned) {
  GivenLights given = given_lights({});
  given.environment = directional_light(3, direction_from_angles(30, 10), std::array<float, 3>{1, 1, 1});
  LightChoice choice = given_choice(given, LightWindow::none);
  EXPECT_TRUE(choice.environment);
  choice.azimuth_degrees += 25;
  EXPECT_EQ(environment_turn_degrees(choice, given), 25);
  const LightCoefficients turned = lights_of(choice, given).incident(3, {0, 0, 0});
  const LightCoefficients expected = directional_light(3, direction_from_angles(55, 10), std::array<float, 3>{1, 1, 1});
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(turned.channels[1][i], expected.channels[1][i], 1e-5);
}

TEST(ViewLights, BandsAreCutOff) {
  const Scratch scratch;
  write_asset(scratch.folder(), shapes::plane(1), noise_stack(8, 8, 4, 1, 8));
  const PrtAsset asset = load_prt_asset(scratch.folder());
  const IncidentSamples samples = place_incident_samples(asset.mesh, 1);
  const SceneLights lights{{parse_light_spec("20,40")}, std::nullopt, LightWindow::hann};
  const LightCoefficients all = light_for_asset(lights, 4, asset, samples).samples[0];
  const LightCoefficients two = light_for_asset(lights, 2, asset, samples).samples[0];
  EXPECT_EQ(two.bands, 4);
  const LightCoefficients of_two = lights.incident(2, {0, 0, 0});  // windowed for two
  for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(two.channels[0][i], i < 4 ? of_two.channels[0][i] : 0) << i;
  EXPECT_NE(all.channels[0][15], 0);
}

TEST(ViewLights, ACoefficientIsALight) {
  const Scratch scratch;
  write_asset(scratch.folder(), shapes::plane(1), noise_stack(8, 8, 2, 3, 16));
  const PrtAsset asset = load_prt_asset(scratch.folder());
  const IncidentSamples samples = place_incident_samples(asset.mesh, 1);
  std::vector<float> transfer(12);
  decode_transfer(asset, std::vector<std::uint32_t>{19}, transfer);
  for (int coefficient = 0; coefficient < 12; ++coefficient) {
    const LightCoefficients light = light_of_coefficient(coefficient, asset, samples).samples[0];
    const Image<float> radiance = relight_texels(asset, light, {1, 1, 1});
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(radiance.at(3, 2, c), c == coefficient / 4 ? transfer[static_cast<std::size_t>(coefficient)] : 0,
                  1e-6);
  }
}

// ---- files ----

TEST(AssetFolders, AreFound) {
  const Scratch scratch;
  const fs::path asset = scratch.folder() / "hare";
  const auto touch = [](const fs::path& file) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << "{}";
  };
  touch(asset / "prt" / "ranges.json");
  EXPECT_EQ(find_asset_folders(asset, "").plain, asset / "prt");
  EXPECT_EQ(find_asset_folders(asset, "").compressed, "");
  touch(asset / "small" / "pca.json");
  touch(asset / "tiny" / "pca.json");
  EXPECT_EQ(find_asset_folders(asset, "").compressed, asset / "small");
  EXPECT_EQ(find_asset_folders(asset, asset / "tiny").compressed, asset / "tiny");
  EXPECT_EQ(find_asset_folders(asset / "", "").name, "hare");
  EXPECT_EQ(find_asset_folders(asset / "prt" / "", "").name, "hare");
  EXPECT_EQ(find_asset_folders(asset / "prt", "").compressed, "");
  EXPECT_EQ(find_asset_folders(asset / "small", "").plain, "");
  EXPECT_EQ(find_asset_folders(asset / "small", "").name, "hare");
  EXPECT_THROW(find_asset_folders(asset / "small", asset / "tiny"), WrongUsage);
  EXPECT_THROW(find_asset_folders(scratch.folder(), ""), BadInput);
  EXPECT_THROW(find_asset_folders(asset / "prt" / "ranges.json", ""), BadInput);
}

TEST(FileWatch, TellsOfASettledChangeOnce) {
  const Scratch scratch;
  const fs::path file = scratch.folder() / "ranges.json";
  std::ofstream(file) << "{}";
  FileWatch watch({scratch.folder()});
  EXPECT_FALSE(watch.changed());
  fs::create_directories(scratch.folder() / ".kiln-staging");
  std::ofstream(scratch.folder() / ".kiln-staging" / "coeff_0_00.png") << "half";
  EXPECT_FALSE(watch.changed());
  EXPECT_FALSE(watch.changed()) << "what is being written does not count";
  std::ofstream(file) << "{ }";
  EXPECT_FALSE(watch.changed()) << "it may still be written to";
  EXPECT_TRUE(watch.changed());
  EXPECT_FALSE(watch.changed());
  fs::last_write_time(file, fs::last_write_time(file) + std::chrono::seconds(2));
  EXPECT_FALSE(watch.changed());
  EXPECT_TRUE(watch.changed()) << "the same size at another time";
  fs::remove_all(scratch.folder());
  EXPECT_FALSE(watch.changed());
  EXPECT_TRUE(watch.changed());
}

TEST(Script, IsReadStepByStep) {
  const Scratch scratch;
  const fs::path file = scratch.folder() / "script.txt";
  std::ofstream(file) << "# a comment\nkey 3 ] escape\n\n  drag right 10 -5.5  # the light\nwheel -2\nresize 640 480\n"
                         "frames 7\nscreenshot a.png\nwindow b.png\nreload\n";
  const std::vector<ScriptStep> steps = read_script(file);
  ASSERT_EQ(steps.size(), 10u);
  EXPECT_EQ(steps[1].key, ']');
  EXPECT_EQ(steps[2].key, escape_key);
  EXPECT_EQ(steps[3].what, Drag::light);
  EXPECT_EQ(steps[3].y, -5.5);
  EXPECT_EQ(steps[4].x, -2);
  EXPECT_EQ(steps[5].y, 480);
  EXPECT_EQ(steps[8].kind, ScriptStep::Kind::window);
  EXPECT_EQ(steps[8].file, "b.png");
  for (const char* wrong : {"jump", "key", "key z", "drag up 1 2", "drag left 1", "wheel", "wheel far", "resize 10 10",
                            "frames 0", "screenshot a.jpg", "window", "reload now"}) {
    std::ofstream(file) << "key n\n" << wrong << "\n";
    try {
      read_script(file);
      ADD_FAILURE() << wrong;
    } catch (const BadInput& error) {
      EXPECT_NE(std::string(error.what()).find("line 2"), std::string::npos) << error.what();
    }
  }
}

// ---- pictures ----

TEST(Panel, ColumnsAreAligned) {
  const Panel panel{"Title", {{"A", "same"}, {"A much longer label", "same"}}};
  const Image<std::uint8_t> picture = panel_picture(panel, 1), large = panel_picture(panel, 2);
  EXPECT_NEAR(large.width(), 2 * picture.width(), 12);
  EXPECT_NEAR(large.height(), 2 * picture.height(), 4);
  EXPECT_EQ(picture.at(0, 0, 3), 0) << "round corners";
  EXPECT_NEAR(picture.at(picture.width() / 2, 0, 3), 0.78 * 255, 1);
  // The two values are the same picture one line of 20 pixels apart: from the left of the values to the margin.
  const int left = picture.width() - 12 - (picture.width() - 12) / 6, baseline = 12;
  int ink = 0;
  for (int j = baseline - 4; j < baseline + 14; ++j)
    for (int i = left; i < picture.width() - 12; ++i) {
      EXPECT_EQ(picture.at(i, j, 0), picture.at(i, j + 20, 0));
      ink += picture.at(i, j, 0) > 150;
    }
  EXPECT_GT(ink, 20);
}

TEST(Panel, AStripFitsAndLosesNothing) {
  const Panel panel{"hare", {{"Technique", "Phong"}, {"Light", "directional 45, 30"}, {"Bands", "5 of 5"}}};
  EXPECT_EQ(strip_of(panel, 10000, 1).rows.size(), 1u);
  const Panel strip = strip_of(panel, 240, 1);
  EXPECT_GT(strip.rows.size(), 1u);
  EXPECT_LE(panel_picture(strip, 1).width(), 240);
  std::string all;
  for (const PanelRow& row : strip.rows) all += row.value + " ";
  for (const char* word : {"hare", "Technique: Phong", "Light: directional 45, 30", "Bands: 5 of 5"})
    EXPECT_NE(all.find(word), std::string::npos) << all;
}

/// A sphere on the GPU, as the window would show it.
struct Shown {
  Scratch scratch;
  std::unique_ptr<EglContext> context = software_context();
  RenderSettings settings;
  ViewScene scene;
  ViewState state;

  explicit Shown(int supersample = 2) {
    const TriangleMesh mesh = shapes::cube_sphere(8);
    write_asset(scratch.folder(), mesh, unoccluded_stack(mesh, 48, 32, 3, 16));
    settings.width = 120;
    settings.height = 80;
    settings.supersample = supersample;
    LightSettings lights;
    lights.lights = {"60,40,1,0.7,0.4"};
    scene = load_view_scene({"sphere", scratch.folder(), {}}, lights);
    // The contract's asset names a normal map, which the test writes none of.
    scene.forms.plain->normals_file.clear();
    state.orbit = home_orbit({});
    state.light = given_choice(scene.lights, LightWindow::hann);
    state.bands = 3;
  }

  Image<std::uint8_t> picture(const Resolve& how) {
    AssetView asset(scene, settings, state);
    Canvas canvas(settings.width, settings.height, settings.supersample);
    asset.draw(state, camera_of(state.orbit, asset.shape(), settings.width, settings.height), canvas);
    Screen screen;
    screen.resolve(canvas, how);
    return screen.picture();
  }
};

TEST(Screen, ShowsTheSamePictureAsARender) {
  for (const int supersample : {1, 3}) {
    Shown shown(supersample);
    for (const bool has_background : {false, true}) {
      Resolve how;
      how.picture.exposure_stops = 0.7;
      if (has_background) how.picture.background = {{0.1f, 0.2f, 0.6f}};
      const Image<std::uint8_t> picture = shown.picture(how);
      AssetRenderer renderer(*shown.scene.forms.plain);
      const Image<std::uint8_t> expected = picture_from_radiance(
          render_scene({{&renderer, {}, Technique::textured_prt}}, lights_of(shown.state.light, shown.scene.lights),
                       views_of(shown.settings, shown.scene.forms.main().mesh.positions).front()),
          how.picture);
      ASSERT_EQ(picture.channels(), expected.channels());
      int largest = 0, brightest = 0;
      for (std::size_t k = 0; k < picture.values().size(); ++k) {
        // A pixel that shows nothing has no colour.
        if (!has_background && expected.values()[k | 3] == 0 && picture.values()[k | 3] == 0) continue;
        largest = std::max(largest, std::abs(picture.values()[k] - expected.values()[k]));
        brightest = std::max<int>(brightest, expected.values()[k]);
      }
      // The same samples, averaged and curved in float32 by the GPU and by the CPU: a value halfway between two bytes
      // may fall to either.
      EXPECT_LE(largest, 1) << supersample << " samples, background " << has_background;
      EXPECT_GT(brightest, 200);
    }
  }
}

TEST(Screen, ADifferenceIsThatOfThePictures) {
  Shown shown;
  shown.state.show = Show::difference;
  Resolve how;
  how.show = Show::difference;
  how.gain = 1000;
  how.weights = {0.2126f, 0.7152f, 0.0722f};
  const auto count = [](const Image<std::uint8_t>& picture, const auto& is_counted) {
    int counted = 0;
    for (int j = 0; j < picture.height(); ++j)
      for (int i = 0; i < picture.width(); ++i)
        if (picture.at(i, j, 3) == 255) counted += is_counted(picture.pixel(i, j)) ? 1 : 0;
    return counted;
  };
  const auto covered = [](const auto&) { return true; };
  // Empty parts are 0.84 in all colours, 214 of 255.
  const auto is_nothing = [](const auto& pixel) { return pixel[0] == 214 && pixel[1] == 214 && pixel[2] == 214; };
  const Image<std::uint8_t> same = shown.picture(how);
  EXPECT_GT(count(same, covered), 1000);
  EXPECT_EQ(count(same, is_nothing), count(same, covered));
  // One band of three of a hemisphere, which is the one light that is not scaled to what faces it: too dark where the
  // sky is, which is where the camera stands, too bright behind.
  shown.state.bands = 1;
  shown.state.light.preset = LightPreset::hemisphere;
  shown.state.orbit.azimuth_degrees = 60;
  const auto is_below = [](const auto& pixel) { return pixel[2] > pixel[0] + 100; };
  const auto is_above = [](const auto& pixel) { return pixel[0] > pixel[2] + 100; };
  const Image<std::uint8_t> front = shown.picture(how);
  EXPECT_TRUE(is_below(front.pixel(60, 50)));
  shown.state.orbit.azimuth_degrees = -120;
  const Image<std::uint8_t> back = shown.picture(how);
  EXPECT_TRUE(is_above(back.pixel(60, 40)));
}

TEST(Screen, ACoefficientIsSignedAndScaled) {
  // t_2 (l 1, m 0) of an unoccluded sphere goes with z: from blue to red.
  Shown shown;
  shown.state.show = Show::coefficient;
  shown.state.coefficient = 2;
  shown.state.orbit.elevation_degrees = 0;
  Resolve how;
  how.show = Show::coefficient;
  how.weights.fill(1.f / 3);
  AssetView asset(shown.scene, shown.settings, shown.state);
  const auto [lowest, highest] = asset.coefficient_range(2, Technique::textured_prt);
  // 2/3 sqrt(3 / (4 pi)): the clamped cosine's second band over pi times Y_1's peak, as far as texels reach the pole.
  EXPECT_NEAR(highest, 2.0 / 3 * std::sqrt(3 / (4 * std::numbers::pi)), 0.01);
  EXPECT_NEAR(lowest, -highest, 0.01);
  how.gain = static_cast<float>(1 / highest);
  for (const auto& [azimuth, red, blue] : {std::tuple{0, 194, 20}, std::tuple{180, 25, 189}}) {
    shown.state.orbit.azimuth_degrees = azimuth;
    const Image<std::uint8_t> picture = shown.picture(how);
    EXPECT_NEAR(picture.at(60, 40, 0), red, 6) << azimuth;
    EXPECT_NEAR(picture.at(60, 40, 2), blue, 6) << azimuth;
  }
}

TEST(Inspection, ShowsNormalsChartsAndEdges) {
  Shown shown;
  shown.state.orbit.azimuth_degrees = 90;
  shown.state.orbit.elevation_degrees = 0;
  Resolve how;
  how.show = shown.state.show = Show::normals;
  const Image<std::uint8_t> normals = shown.picture(how);
  // The middle of the sphere faces the camera at +X.
  EXPECT_NEAR(normals.at(60, 40, 0), 255, 3);
  EXPECT_NEAR(normals.at(60, 40, 1), 128, 12);
  EXPECT_NEAR(normals.at(60, 40, 2), 128, 12);
  how.show = shown.state.show = Show::charts;
  const Image<std::uint8_t> charts = shown.picture(how);
  shown.state.mesh = how.edges = true;
  const Image<std::uint8_t> with_edges = shown.picture(how);
  int changed = 0, covered = 0;
  for (int j = 0; j < charts.height(); ++j)
    for (int i = 0; i < charts.width(); ++i) {
      if (charts.at(i, j, 3) < 255) continue;
      ++covered;
      changed += std::abs(charts.at(i, j, 0) - with_edges.at(i, j, 0)) > 20;
    }
  EXPECT_GT(changed, covered / 10);
  EXPECT_LT(changed, covered * 9 / 10);
  std::set<std::array<int, 3>> colors;
  for (std::size_t k = 0; k < 40; ++k) {
    const Eigen::Vector3f color = chart_color(k);
    EXPECT_TRUE(color.minCoeff() >= 0 && color.maxCoeff() <= 1);
    colors.insert({static_cast<int>(20 * color[0]), static_cast<int>(20 * color[1]), static_cast<int>(20 * color[2])});
  }
  EXPECT_GT(colors.size(), 30u);
}

}  // namespace
}  // namespace kiln
