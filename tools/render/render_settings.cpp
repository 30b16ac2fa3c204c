// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/render_settings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "base/numbers.h"
#include "runtime/light/incident_samples.h"

namespace kiln {

namespace {

int parse_incident_samples(const std::string& text) {
  if (text == "auto") return 0;
  if (text == "vertices") return samples_at_vertices;
  if (text.size() == 1 && text[0] >= '1' && text[0] <= '0' + most_incident_samples) return text[0] - '0';
  throw WrongUsage("incident-samples: found '" + text + "'; expected auto, vertices, or 1 to " +
                   std::to_string(most_incident_samples));
}

}  // namespace

OptionSet render_options(RenderSettings& settings) {
  OptionSet options;
  options
      .choice("technique", settings.technique,
              {{"auto", TechniqueChoice::automatic},
               {"phong", TechniqueChoice::phong},
               {"normal-map", TechniqueChoice::normal_map},
               {"vertex-prt", TechniqueChoice::vertex_prt},
               {"textured-prt", TechniqueChoice::textured_prt},
               {"compressed", TechniqueChoice::compressed},
               {"all", TechniqueChoice::all}},
              "How to shade; auto is what the asset was made for, all a sheet of every technique it can be drawn by")
      .choice("space", settings.space, {{"camera", PictureSpace::camera}, {"texture", PictureSpace::texture}},
              "texture: the relit atlas itself, texel for texel, gutters included; needs no GPU")
      .integer("level", settings.level, 0, most_levels,
               "Of detail of each asset: 0 for its own mesh, 1 for the finest of its coarser ones; the camera stands "
               "where it would for 0")
      .toggle("side-by-side", settings.side_by_side, "Each asset by itself on a sheet, with its folder's name")
      .parsed(
          "incident-samples", "auto, vertices, or 1 to 8",
          "Points around each asset at which the incident light is computed; vertices: at every vertex of its mesh, "
          "for shadows smaller than it; auto: 8 if a light is a sphere, or things shadow each other, else 1",
          [&settings](const std::string& text) { settings.incident_samples = parse_incident_samples(text); },
          [&settings] {
            if (settings.incident_samples == samples_at_vertices) return std::string("vertices");
            return settings.incident_samples == 0 ? std::string("auto") : std::to_string(settings.incident_samples);
          })
      .choice("shading", settings.shading, {{"forward", Shading::forward}, {"deferred", Shading::deferred}},
              "deferred lights only what is visible, after all is drawn: faster where many surfaces lie behind one "
              "another")
      .number("specular", settings.specular, 0, 1, "Reflectance of the highlight of phong and normal-map")
      .number("shininess", settings.shininess, 1, 10000, "Power of its cosine")
      .text("camera", settings.camera,
            "Where the camera stands: AZIMUTH,ELEVATION in degrees (0,0 is +Z, which is the front whatever --up was; "
            "90,0 "
            "is +X); of a scene also the name of one of its cameras")
      .number("field-of-view", settings.field_of_view_degrees, 1, 120, "Of the camera, vertical, degrees");
  add_framing_options(options, settings.framing);
  options
      .integer("frames", settings.frames, 1, 3600,
               "More than 1: a turntable of so many pictures, NAME_000.png and so on, the camera once around; of a "
               "scene that moves, a film")
      .integer("width", settings.width, 1, 8192, "Of the picture, pixels")
      .integer("height", settings.height, 1, 8192, "Of the picture, pixels")
      .integer("supersample", settings.supersample, 1, 8,
               "Samples per pixel along each axis, averaged in linear radiance")
      .text("albedo", settings.albedo,
            "Linear reflectance of 0 to 1, one number or R,G,B, times the asset's own; auto: 1 where the asset knows "
            "its own, "
            "else 0.8")
      .text("background", settings.background,
            "Linear colour behind the asset: none (transparent), one number or R,G,B")
      .number("exposure", settings.exposure_stops, -20, 20, "Doubles the brightness of a PNG so many times")
      .choice("tone", settings.tone, {{"srgb", ToneCurve::srgb}, {"linear", ToneCurve::linear}},
              "Curve from linear radiance, clamped to 0..1, to a PNG's values")
      .text("gl-device", settings.gl_device, "auto, software, or the number of an EGL device");
  return options;
}

CameraSettings camera_settings_of(const RenderSettings& settings) {
  const std::vector<double> angles = parse_numbers("camera", settings.camera, -360, 360);
  if (angles.size() != 2 || std::abs(angles[1]) > 90)
    throw WrongUsage("camera: found '" + settings.camera + "'; expected AZIMUTH,ELEVATION, an elevation of -90 to 90");
  CameraSettings camera;
  camera.azimuth_degrees = angles[0];
  camera.elevation_degrees = angles[1];
  camera.field_of_view_degrees = settings.field_of_view_degrees;
  camera.zoom = settings.framing.zoom;
  if (const auto place = settings.framing.target_place()) camera.target = Eigen::Vector3d(place->data());
  camera.distance = settings.framing.target_distance();
  return camera;
}

std::vector<SceneView> views_of(const RenderSettings& settings, std::span<const Eigen::Vector3f> shape) {
  CameraSettings camera = camera_settings_of(settings);
  SceneView view;
  view.width = settings.width;
  view.height = settings.height;
  view.supersample = settings.supersample;
  view.look = look_of(settings);
  view.shading = settings.shading;
  if (settings.frames == 1) {
    view.camera = make_camera(shape, camera, settings.width, settings.height);
    return {view};
  }
  if (!camera.target) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3f& vertex : shape) box.extend(vertex.cast<double>());
    camera.target = box.center();
  }
  const double first_azimuth_degrees = camera.azimuth_degrees;
  std::vector<SceneView> views;
  // Runs twice, so that the frame that needs the largest distance sets that of all.
  double distance = camera.distance;
  for (int pass = distance > 0 ? 1 : 0; pass < 2; ++pass) {
    views.clear();
    if (pass == 1) camera.distance = distance;
    for (int frame = 0; frame < settings.frames; ++frame) {
      camera.azimuth_degrees = first_azimuth_degrees + 360.0 * frame / settings.frames;
      view.camera = make_camera(shape, camera, settings.width, settings.height);
      views.push_back(view);
      if (pass == 0) distance = std::max(distance, (view.camera.position.cast<double>() - *camera.target).norm());
    }
  }
  return views;
}

SurfaceLook look_of(const RenderSettings& settings) {
  SurfaceLook look;
  if (settings.albedo != "auto") look.albedo = parse_color("albedo", settings.albedo, 0, 1);
  look.specular = static_cast<float>(settings.specular);
  look.shininess = static_cast<float>(settings.shininess);
  return look;
}

PictureSettings picture_of(const RenderSettings& settings) {
  PictureSettings picture;
  picture.exposure_stops = settings.exposure_stops;
  picture.tone = settings.tone;
  if (settings.background != "none") picture.background = parse_color("background", settings.background, 0, 1e6);
  return picture;
}

Technique technique_of(const RenderSettings& settings, const PrtAsset& asset) {
  switch (settings.technique) {
    case TechniqueChoice::phong:
      return Technique::phong;
    case TechniqueChoice::normal_map:
      return Technique::normal_map;
    case TechniqueChoice::vertex_prt:
      return Technique::vertex_prt;
    case TechniqueChoice::textured_prt:
      return Technique::textured_prt;
    case TechniqueChoice::compressed:
      return Technique::compressed;
    default:
      return natural_technique(asset);
  }
}

int incident_samples_of(const RenderSettings& settings, bool local_lights) {
  return settings.incident_samples != 0 ? settings.incident_samples : local_lights ? most_incident_samples : 1;
}

}  // namespace kiln
