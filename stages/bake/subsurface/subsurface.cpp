// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/subsurface/subsurface.h"

#include <cmath>
#include <numeric>

#include "bake/subsurface/scattering.h"
#include "bake/subsurface/surface_samples.h"
#include "base/stopwatch.h"

namespace kiln {

namespace {

/// Largest ratio between the areas of the receivers and of the high mesh, for that to be their surface: a first
/// occluder of another kind, such as a floor, is not.
constexpr double largest_correction = 1.25;

/// Scales areas so that they sum to `area`, where that is near; returns the factor.
double correct_areas(std::vector<float>& areas, double area) {
  const double sum = std::accumulate(areas.begin(), areas.end(), 0.0);
  if (!(area > 0 && area < sum * largest_correction && sum < area * largest_correction)) return 1;
  for (float& a : areas) a = static_cast<float>(a * (area / sum));
  return area / sum;
}

}  // namespace

SubsurfaceReport scatter_beneath(const SubsurfaceScene& scene, const SubsurfaceSettings& settings,
                                 std::vector<TransferVectors>& channels, const ProgressFunction& progress) {
  const Stopwatch stopwatch;
  std::vector<ScatterProfile> profiles = subsurface_profiles(settings);
  if (profiles.size() == 1) profiles.resize(channels.size(), profiles.front());

  // Step 1: make receivers into discs of a surface in millimetres.
  SubsurfaceReport report;
  const auto scale = static_cast<float>(settings.mm_per_unit);
  SurfaceSamples samples{
      scene.receivers.positions, scene.receivers.normals,
      scene.per_vertex ? vertex_areas(scene.mesh, scene.receivers) : texel_areas(scene.mesh, scene.receivers)};
  report.area_correction = correct_areas(samples.areas, scene.high_area);
  for (Eigen::Vector3f& position : samples.positions) position *= scale;
  for (float& area : samples.areas) area *= scale * scale;

  // Step 2: scatter.
  Scattering scattered = scatter_transfer(samples, channels, profiles, {.solid_angle = settings.solid_angle}, progress);
  channels = std::move(scattered.transfer);

  for (const ScatterProfile& profile : profiles) report.reflectance.push_back(profile.total());
  report.energy = scattered.energy;
  report.hierarchy_error = scattered.hierarchy_error;
  report.error_points = scattered.error_points;
  report.largest_gain = scattered.largest_gain;
  report.capped_area = scattered.capped_area;
  report.area_mm2 = std::accumulate(samples.areas.begin(), samples.areas.end(), 0.0);
  report.spacing_mm = std::sqrt(report.area_mm2 / static_cast<double>(samples.size()));
  report.seconds = stopwatch.seconds();
  return report;
}

}  // namespace kiln
