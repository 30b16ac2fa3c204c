#include "relight/light/incident_samples.h"

#include <algorithm>
#include <stdexcept>

namespace kiln {

namespace {

/// Both extremes of x, y and z, then farthest points; each place once.
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
    if (distance(*farthest) == 0) break;  // a mesh of fewer vertices
    points.push_back(*farthest);
  }
  return points;
}

}  // namespace

IncidentSamples place_incident_samples(const TriangleMesh& mesh, int count) {
  if (count < 1 || count > most_incident_samples || mesh.positions.empty())
    throw std::invalid_argument("place_incident_samples: 1 to 8 samples, of a mesh with vertices");
  IncidentSamples samples;
  if (count == 1) {
    samples.points = {bounding_box(mesh).centre()};
    samples.contributions.assign(mesh.positions.size(), 1.f);
    return samples;
  }
  samples.points = spread_points(mesh, static_cast<std::size_t>(count));
  for (const Eigen::Vector3f& vertex : mesh.positions) {
    // Over the least distance, so that a vertex next to a sample, or on it, overflows nothing.
    std::vector<double> squared;
    for (const Eigen::Vector3f& point : samples.points)
      squared.push_back((vertex - point).cast<double>().squaredNorm());
    const double least = *std::min_element(squared.begin(), squared.end());
    double sum = 0;
    for (double& value : squared) {
      value = value > least ? least / value : 1;
      sum += value;
    }
    for (const double value : squared) samples.contributions.push_back(static_cast<float>(value / sum));
  }
  return samples;
}

}  // namespace kiln
