// SPDX-License-Identifier: MIT
#include "runtime/light/incident_samples.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <stdexcept>

namespace kiln {

namespace {

/// How far from the centre towards the vertices samples stand: at the two Chebyshev nodes of a span. Where light
/// curves, linear interpolation then errs by half as much, at worst, as between the ends of the span; and a shadow that
/// only touches an end of the mesh does not count for half of it.
constexpr double outwards = 0.70710678118654752;

/// Returns the centre of mass of the surface.
Eigen::Vector3f centre_of(const TriangleMesh& mesh) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double whole = 0;
  for (const Triangle& triangle : mesh.triangles) {
    const double area = area_normal(mesh, triangle).cast<double>().norm();
    for (const std::uint32_t vertex : triangle) sum += area / 3 * mesh.positions[vertex].cast<double>();
    whole += area;
  }
  return whole > 0 ? Eigen::Vector3f((sum / whole).cast<float>()) : bounding_box(mesh).centre();
}

/// Picks vertices: both extremes along x, y and z, then the farthest from all so far; each position once.
std::vector<Eigen::Vector3f> spread_points(const TriangleMesh& mesh, std::size_t count) {
  std::vector<Eigen::Vector3f> points;
  const auto add = [&](const Eigen::Vector3f& point) {
    if (std::find(points.begin(), points.end(), point) == points.end()) points.push_back(point);
  };
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax_element(mesh.positions.begin(), mesh.positions.end(),
                                                 [&](const auto& a, const auto& b) { return a[axis] < b[axis]; });
    add(*low);
    add(*high);
  }
  if (points.size() > count) points.resize(count);
  while (points.size() < count) {
    const auto distance = [&](const Eigen::Vector3f& from) {
      float least = std::numeric_limits<float>::max();
      for (const Eigen::Vector3f& point : points) least = std::min(least, (from - point).squaredNorm());
      return least;
    };
    const auto farthest = std::max_element(mesh.positions.begin(), mesh.positions.end(),
                                           [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
    if (distance(*farthest) == 0) break;  // the mesh has no other positions
    points.push_back(*farthest);
  }
  return points;
}

/// Computes contributions by moving least squares of linear functions, distances as fractions of `unit`.
std::vector<double> contributions_at(const Eigen::Vector3f& place, const std::vector<Eigen::Vector3f>& points,
                                     double unit) {
  // Divides by the least distance, so that a place next to a sample, or on it, overflows nothing.
  std::vector<double> weights;
  std::vector<Eigen::Vector4d> functions;
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3d offset = (point - place).cast<double>() / unit;
    weights.push_back(offset.squaredNorm());
    functions.emplace_back(1, offset.x(), offset.y(), offset.z());
  }
  const double least = *std::min_element(weights.begin(), weights.end());
  double sum = 0;
  for (double& weight : weights) sum += weight = weight > least ? least / weight : 1;

  // A few points in a plane leave the slope across it undefined: a small multiple of the identity keeps it near 0.
  constexpr double ridge = 0.003;
  Eigen::Matrix4d moments = Eigen::Matrix4d::Zero();
  moments.diagonal() << 0, ridge, ridge, ridge;
  for (std::size_t k = 0; k < points.size(); ++k) moments += weights[k] / sum * functions[k] * functions[k].transpose();
  const Eigen::Vector4d value_at_place = moments.inverse().col(0);
  double total = 0;
  for (std::size_t k = 0; k < points.size(); ++k) total += weights[k] *= value_at_place.dot(functions[k]);
  for (double& weight : weights) weight /= total;
  return weights;
}

}  // namespace

IncidentSamples place_incident_samples(const TriangleMesh& mesh, int count) {
  if (count == samples_at_vertices) return {mesh.positions, {}};
  if (count < 1 || count > most_incident_samples || mesh.positions.empty())
    throw std::invalid_argument("place_incident_samples: 1 to 8 samples, of a mesh with vertices");
  IncidentSamples samples;
  if (count == 1) {
    samples.points = {bounding_box(mesh).centre()};
    samples.contributions.assign(mesh.positions.size(), 1.f);
    return samples;
  }
  samples.points = spread_points(mesh, static_cast<std::size_t>(count));
  const Eigen::Vector3f centre = centre_of(mesh);
  for (Eigen::Vector3f& point : samples.points) point = centre + static_cast<float>(outwards) * (point - centre);
  const double unit = std::max(0.5 * outwards * static_cast<double>(bounding_box(mesh).diagonal()), 1e-30);
  for (const Eigen::Vector3f& vertex : mesh.positions) {
    const std::vector<double> contributions = contributions_at(vertex, samples.points, unit);
    samples.contributions.insert(samples.contributions.end(), contributions.begin(), contributions.end());
  }
  return samples;
}

}  // namespace kiln
