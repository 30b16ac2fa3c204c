// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "base/framing_options.h"
#include "base/options.h"
#include "mesh/camera.h"
#include "render/output/picture.h"
#include "runtime/draw/scene_view.h"
#include "runtime/draw/technique.h"

namespace kiln {

/// Technique that a picture is drawn by.
enum class TechniqueChoice { automatic, phong, normal_map, vertex_prt, textured_prt, compressed, all };

/// Meaning of a picture's pixels.
enum class PictureSpace {
  camera,   ///< the view of a camera
  texture,  ///< texels of the asset's atlas
};

/// Settings of how assets are drawn.
struct RenderSettings {
  TechniqueChoice technique = TechniqueChoice::automatic;
  PictureSpace space = PictureSpace::camera;
  int level = 0;              ///< of detail, of each asset; 0: its own mesh
  bool side_by_side = false;  ///< several assets, each by itself on a sheet
  /// Points of incident light around each asset, or samples_at_vertices; 0: 8 if a light is local, else 1.
  int incident_samples = 0;
  Shading shading = Shading::forward;
  double specular = 0;  ///< Phong techniques only: reflectance of the highlight
  double shininess = 32;
  std::string camera = "20,12";  ///< azimuth and elevation, degrees; the front is +Z
  double field_of_view_degrees = 30;
  FramingSettings framing;
  int frames = 1;               ///< more than 1: a turntable
  int width = 768;              ///< pixels
  int height = 768;             ///< pixels
  int supersample = 2;          ///< samples per pixel along each axis
  std::string albedo = "auto";  ///< linear, one number or R,G,B, multiplied by the asset's own
  std::string background = "none";
  double exposure_stops = 0;
  ToneCurve tone = ToneCurve::srgb;
  std::string gl_device = "auto";
};

/// Tests whether the picture is a sheet of pictures.
inline bool is_sheet(const RenderSettings& settings) {
  return settings.side_by_side || settings.technique == TechniqueChoice::all;
}

OptionSet render_options(RenderSettings& settings);

/// Returns the position and direction of the camera. Throws WrongUsage.
CameraSettings camera_settings_of(const RenderSettings& settings);

/// Makes one view of a shape, given by its vertices, for each frame. Over several frames the camera goes around +Y and
/// around the target (for `auto` the middle of the vertices' box), at a constant distance. Throws WrongUsage.
std::vector<SceneView> views_of(const RenderSettings& settings, std::span<const Eigen::Vector3f> shape);

/// Returns the look of the surface. Throws WrongUsage.
SurfaceLook look_of(const RenderSettings& settings);

/// Returns how radiance becomes pixels. Throws WrongUsage.
PictureSettings picture_of(const RenderSettings& settings);

/// Returns the one technique that was asked for, for an asset; not for `all`.
Technique technique_of(const RenderSettings& settings, const PrtAsset& asset);

/// Returns the number of incident-light samples.
int incident_samples_of(const RenderSettings& settings, bool local_lights);

}  // namespace kiln
