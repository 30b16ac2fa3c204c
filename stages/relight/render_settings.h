#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "base/options.h"
#include "mesh/camera.h"
#include "relight/picture.h"
#include "relight/prt_renderer.h"
#include "sh/light_spec.h"
#include "sh/lights.h"

namespace kiln {

/// The lights of a picture; they add up.
struct LightSettings {
  std::vector<std::string> lights;          ///< as parse_light_spec takes them; "45,30" where there is no light at all
  std::string ambient = "none";             ///< radiance from everywhere, one number or R,G,B
  std::filesystem::path environment;        ///< latitude-longitude EXR or HDR; empty: none
  double environment_rotation_degrees = 0;  ///< about +Y
  LightWindow window = LightWindow::hann;
};

/// How an asset is drawn.
struct RenderSettings {
  std::string camera = "20,12";  ///< azimuth and elevation, degrees
  double field_of_view_degrees = 30;
  int width = 768;             ///< pixels
  int height = 768;            ///< pixels
  int supersample = 2;         ///< samples per pixel along each axis
  std::string albedo = "0.8";  ///< linear, one number or R,G,B
  std::string background = "none";
  double exposure_stops = 0;
  ToneCurve tone = ToneCurve::srgb;
  std::string gl_device = "auto";
};

OptionSet light_options(LightSettings& settings);
OptionSet render_options(RenderSettings& settings);

/// The light specifications of `settings`, without the environment. Throws WrongUsage.
std::vector<LightSpec> light_specs(const LightSettings& settings);

/// All lights of `settings`, windowed; three channels. Throws WrongUsage, BadInput.
LightCoefficients all_lights(const LightSettings& settings, int bands);

/// How to draw a mesh with that bounding box. Throws WrongUsage.
PrtView view_of(const RenderSettings& settings, const BoundingBox& box);

/// How to show the radiance. Throws WrongUsage.
PictureSettings picture_of(const RenderSettings& settings);

}  // namespace kiln
