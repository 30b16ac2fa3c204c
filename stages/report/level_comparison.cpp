// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/level_comparison.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/json.h"
#include "report/picture_difference.h"
#include "report/pictures.h"

namespace kiln {

namespace {

/// Camera that distances were proposed for.
struct ProposedCamera {
  double lines = 1080;
  double vertical_fov_degrees = 45;
};

ProposedCamera proposed_camera(const AssetFolder& asset) {
  ProposedCamera camera;
  for (const StageRecord& record : asset.records)
    if (record.stage == "lod") {
      const Json settings = record.json.value("settings", Json::object());
      camera.lines = settings.value("lines", camera.lines);
      camera.vertical_fov_degrees = settings.value("fov", camera.vertical_fov_degrees);
    }
  return camera;
}

/// Returns the view of an asset in which a level takes the place of the one before.
RenderedView switching_view(const BoundingBox& box, double distance, const ProposedCamera& camera, RenderedView view) {
  const double radius = 0.5 * box.diagonal();
  const Eigen::Vector3f centre = box.centre();
  // The sphere about the asset is as large as this in the picture, which never is larger than the camera's.
  const double half_tangent = std::tan(camera.vertical_fov_degrees * std::numbers::pi / 360);
  const double away = distance * distance - radius * radius;
  const double sphere = away > 0 ? camera.lines * radius / (std::sqrt(away) * half_tangent) : camera.lines;
  view.size = static_cast<int>(std::clamp(std::ceil(sphere) + 2, 8.0, camera.lines));
  view.field_of_view_degrees = camera.vertical_fov_degrees;
  view.framing.zoom = camera.lines / view.size;
  view.framing.target = fmt::format("{},{},{}", centre.x(), centre.y(), centre.z());
  view.framing.distance = fmt::format("{}", std::max(distance, 1e-6 * radius));
  return view;
}

void measure_popping(const Image<float>& before, const Image<float>& after, LevelComparison& level) {
  const auto pixels = static_cast<std::size_t>(before.width()) * static_cast<std::size_t>(before.height());
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    const float* const a = before.values().data() + 4 * pixel;
    const float* const b = after.values().data() + 4 * pixel;
    const bool inside = is_wholly_covered(a[3]) && is_wholly_covered(b[3]);
    for (int c = 0; c < 3; ++c) {
      const double change = std::abs(static_cast<double>(a[c]) - b[c]);
      level.popping = std::max(level.popping, change);
      if (inside) level.popping_inside = std::max(level.popping_inside, change);
    }
  }
}

}  // namespace

std::vector<LevelComparison> compare_levels(const AssetFolder& asset, double albedo, const ReportSettings& settings,
                                            const ComparisonRun& run) {
  const TriangleMesh mesh = load_level(asset.prt(), asset.baked, 0);
  const BoundingBox box = bounding_box(mesh);
  const ProposedCamera camera = proposed_camera(asset);
  const std::vector<std::string> lights = list_of(settings.lights);
  RenderedView view = {.azimuth_degrees = settings.camera_azimuth_degrees,
                       .elevation_degrees = settings.camera_elevation_degrees,
                       .framing = settings.framing,
                       .size = settings.picture_size,
                       .albedo = albedo,
                       .gl_device = settings.gl_device};
  const std::vector<Image<float>> own = render_asset(asset, view, lights, run).pictures;
  std::vector<LevelComparison> levels;
  for (const PrtLevel& described : asset.baked.levels) {
    LevelComparison& level = levels.emplace_back();
    level.level = static_cast<int>(levels.size());
    level.described = described;
    view.level = level.level;
    std::vector<Image<float>> pictures = render_asset(asset, view, lights, run).pictures;
    for (std::size_t k = 0; k < lights.size(); ++k)
      level.relative_l2 = std::max(level.relative_l2, compare_pictures(pictures[k], own[k]).relative_l2);
    level.silhouette_difference = silhouette_difference(pictures.front(), own.front());
    level.picture = std::move(pictures.front());

    RenderedView far = switching_view(box, described.distance / mesh.frame.unit(), camera, view);
    level.popping_size = far.size;
    const std::vector<Image<float>> after = render_asset(asset, far, lights, run).pictures;
    far.level = level.level - 1;
    const std::vector<Image<float>> before = render_asset(asset, far, lights, run).pictures;
    for (std::size_t k = 0; k < lights.size(); ++k) measure_popping(before[k], after[k], level);
  }
  return levels;
}

Json to_json(const std::vector<LevelComparison>& levels) {
  Json list = Json::array();
  double relative_l2 = 0, silhouette = 0, popping = 0, popping_inside = 0;
  for (const LevelComparison& level : levels) {
    list.push_back({{"level", level.level},
                    {"triangles", level.described.triangles},
                    {"distance", level.described.distance},
                    {"relative_l2", level.relative_l2},
                    {"silhouette_difference", level.silhouette_difference},
                    {"popping", level.popping},
                    {"popping_inside", level.popping_inside},
                    {"popping_size", level.popping_size}});
    relative_l2 = std::max(relative_l2, level.relative_l2);
    silhouette = std::max(silhouette, level.silhouette_difference);
    popping = std::max(popping, level.popping);
    popping_inside = std::max(popping_inside, level.popping_inside);
  }
  return {{"relative_l2", relative_l2},
          {"silhouette_difference", silhouette},
          {"popping", popping},
          {"popping_inside", popping_inside},
          {"list", std::move(list)}};
}

}  // namespace kiln
