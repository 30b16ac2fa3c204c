#include "relight/render_settings.h"

#include <cmath>

#include "base/errors.h"
#include "relight/environment.h"

namespace kiln {

OptionSet light_options(LightSettings& settings) {
  OptionSet options;
  options.text("ambient", settings.ambient, "Radiance from everywhere (a furnace): one number or R,G,B")
      .number("environment-rotation", settings.environment_rotation_degrees, -360, 360,
              "Turns the environment about +Y, degrees: what was at azimuth a comes to a + this")
      .choice("window", settings.window,
              {{"hann", LightWindow::hann},
               {"lanczos", LightWindow::lanczos},
               {"dering", LightWindow::dering},
               {"none", LightWindow::none}},
              "Weights the bands of all lights, which tames ringing and blurs a little; ambient light stays as it is. "
              "dering is the weakest that leaves no negative light");
  return options;
}

OptionSet render_options(RenderSettings& settings) {
  OptionSet options;
  options
      .text("camera", settings.camera, "Where the camera stands: AZIMUTH,ELEVATION in degrees (0,0 is +Z; 90,0 is +X)")
      .number("field-of-view", settings.field_of_view_degrees, 1, 120, "Of the camera, vertical, degrees")
      .integer("width", settings.width, 1, 8192, "Of the picture, pixels")
      .integer("height", settings.height, 1, 8192, "Of the picture, pixels")
      .integer("supersample", settings.supersample, 1, 8,
               "Samples per pixel along each axis, averaged in linear radiance")
      .text("albedo", settings.albedo, "Linear reflectance of 0 to 1: one number or R,G,B")
      .text("background", settings.background,
            "Linear colour behind the asset: none (transparent), one number or R,G,B")
      .number("exposure", settings.exposure_stops, -20, 20, "Doubles the brightness of a PNG so many times")
      .choice("tone", settings.tone, {{"srgb", ToneCurve::srgb}, {"linear", ToneCurve::linear}},
              "Curve from linear radiance, clamped to 0..1, to a PNG's values")
      .text("gl-device", settings.gl_device, "auto, software, or the number of an EGL device");
  return options;
}

std::vector<LightSpec> light_specs(const LightSettings& settings) {
  std::vector<LightSpec> specs;
  for (const std::string& text : settings.lights) specs.push_back(parse_light_spec(text));
  if (settings.ambient != "none")
    specs.push_back({.kind = LightSpec::Kind::ambient, .colour = parse_colour("ambient", settings.ambient, 0, 1e6)});
  if (specs.empty() && settings.environment.empty()) specs.emplace_back();
  return specs;
}

LightCoefficients all_lights(const LightSettings& settings, int bands) {
  LightCoefficients light = light_coefficients(light_specs(settings), bands, LightWindow::none);
  if (!settings.environment.empty())
    light = add_lights(light, load_environment(settings.environment, bands, settings.environment_rotation_degrees));
  apply_window(light, settings.window);
  return light;
}

PrtView view_of(const RenderSettings& settings, const BoundingBox& box) {
  const std::vector<double> angles = parse_numbers("camera", settings.camera, -360, 360);
  if (angles.size() != 2 || std::abs(angles[1]) > 90)
    throw WrongUsage("camera: found '" + settings.camera + "'; expected AZIMUTH,ELEVATION, an elevation of -90 to 90");
  CameraSettings camera;
  camera.azimuth_degrees = angles[0];
  camera.elevation_degrees = angles[1];
  camera.field_of_view_degrees = settings.field_of_view_degrees;
  PrtView view;
  view.camera = make_camera(box, camera, settings.width, settings.height);
  view.width = settings.width;
  view.height = settings.height;
  view.supersample = settings.supersample;
  view.albedo = parse_colour("albedo", settings.albedo, 0, 1);
  return view;
}

PictureSettings picture_of(const RenderSettings& settings) {
  PictureSettings picture;
  picture.exposure_stops = settings.exposure_stops;
  picture.tone = settings.tone;
  if (settings.background != "none") picture.background = parse_colour("background", settings.background, 0, 1e6);
  return picture;
}

}  // namespace kiln
