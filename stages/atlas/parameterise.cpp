// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/parameterise.h"

#include <Eigen/Geometry>
#include <limits>

#include "atlas/cgal_parameterise.h"
#include "atlas/relax.h"

namespace kiln {

namespace {

/// Mirrors a chart whose map came out mirrored, as some of CGAL's do.
void face_up(Chart& chart) {
  double area = 0;
  for (const Triangle& t : chart.triangles) area += cross(chart.uvs[t[0]], chart.uvs[t[1]], chart.uvs[t[2]]);
  if (area < 0)
    for (Eigen::Vector2d& uv : chart.uvs) uv.x() = -uv.x();
}

void project_to_mean_plane(const Surface& surface, Chart& chart) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (const std::uint32_t face : chart.faces) normal += surface.rest[face].area * surface.face_normals[face];
  const Eigen::Vector3d axis_u = normal.unitOrthogonal(), axis_v = normal.cross(axis_u).normalized();
  const Eigen::Vector3d origin = surface.mesh->positions[chart.vertices[0]].cast<double>();
  chart.uvs.clear();
  for (const std::uint32_t vertex : chart.vertices) {
    const Eigen::Vector3d offset = surface.mesh->positions[vertex].cast<double>() - origin;
    chart.uvs.emplace_back(offset.dot(axis_u), offset.dot(axis_v));
  }
}

bool usable_start(const Surface& surface, Chart& chart) {
  if (chart.uvs.empty()) return false;
  face_up(chart);
  if (!is_flip_free(chart)) return false;
  equalise_area(surface, chart);
  return is_flip_free(chart);
}

}  // namespace

bool is_valid(const Chart& chart) { return is_flip_free(chart) && has_simple_border(chart); }

bool parameterise_quickly(const Surface& surface, Chart& chart) {
  Chart trial = chart;
  trial.parameteriser = Parameteriser::unfolded;
  project_to_mean_plane(surface, trial);
  if (!usable_start(surface, trial)) {
    trial.uvs = cgal_parameterise(surface, trial, Parameteriser::mean_value);
    trial.parameteriser = Parameteriser::mean_value;
    if (!usable_start(surface, trial)) return false;
  }
  relax(surface, trial, {30, 1e-3});
  if (!is_valid(trial)) return false;
  equalise_area(surface, trial);
  chart = std::move(trial);
  return true;
}

bool parameterise(const Surface& surface, Chart& chart) {
  // Large charts come from steps that left little to gain, and each further step takes seconds.
  const RelaxSettings thoroughly = chart.faces.size() < 20000 ? RelaxSettings{40, 1e-3} : RelaxSettings{8, 2e-2};
  bool found = false;
  double least_stretch = std::numeric_limits<double>::infinity();
  Chart best;
  const auto consider = [&](Chart trial) {
    const std::vector<Eigen::Vector2d> start = trial.uvs;
    relax(surface, trial, thoroughly);
    // Relaxing never flips a triangle, but may push parts of the border over one another.
    if (!is_valid(trial)) trial.uvs = start;
    if (!is_valid(trial)) return;
    equalise_area(surface, trial);
    const double stretch = measure_stretch(surface, trial).l2;
    // A later way must win by more than the last digits, which depend on where the relaxation stopped.
    if (!(stretch < least_stretch - 1e-5)) return;
    least_stretch = stretch;
    best = std::move(trial);
    found = true;
  };

  // Once relaxed, all valid starts give about the same map; the chart's own is nearest to it.
  if (!chart.uvs.empty() && is_flip_free(chart)) consider(chart);
  if (found) {
    chart = std::move(best);
    return true;
  }
  for (const Parameteriser parameteriser : {Parameteriser::arap, Parameteriser::lscm, Parameteriser::mean_value}) {
    if (parameteriser == Parameteriser::mean_value && found) break;
    Chart trial = chart;
    trial.parameteriser = parameteriser;
    trial.uvs = cgal_parameterise(surface, trial, parameteriser);
    if (usable_start(surface, trial)) consider(std::move(trial));
  }
  if (found) chart = std::move(best);
  return found;
}

}  // namespace kiln
