// SPDX-License-Identifier: GPL-3.0-or-later
// With uvs fixed, the place that a uv shows is linear in the positions of three vertices, so the texture deviation of
// [Cohen 1998] over all samples is least at the solution of a sparse system of linear equations.
#include "collapse/sample_fit.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

namespace kiln {

namespace {

constexpr int rounds = 3;                 // of the weights by distance
constexpr double least_fit_cosine = 0.5;  // between a triangle's normals before and after
constexpr double least_fit_area = 0.25;   // of a triangle, beside what it was

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// Numbers the unknowns: which one each wedge takes its value from.
struct Unknowns {
  std::vector<std::uint32_t> of_wedge;
  Eigen::Index count = 0;
};

Unknowns points_of(const WedgeMesh& wedges, std::span<const Triangle> triangles) {
  constexpr std::uint32_t none = ~0u;
  Unknowns unknowns{std::vector<std::uint32_t>(wedges.wedge_count(), none), 0};
  std::vector<std::uint32_t> number(wedges.point_count(), none);
  for (const Triangle& triangle : triangles)
    for (const std::uint32_t wedge : triangle) {
      std::uint32_t& own = number[wedges.point_of(wedge)];
      if (own == none) own = static_cast<std::uint32_t>(unknowns.count++);
      unknowns.of_wedge[wedge] = own;
    }
  return unknowns;
}

/// Numbers the normals: wedges of one point and one normal, as at a seam of uvs alone, have one.
Unknowns normals_of(const WedgeMesh& wedges, const TriangleMesh& first, std::span<const Triangle> triangles) {
  Unknowns unknowns{std::vector<std::uint32_t>(wedges.wedge_count(), 0), 0};
  std::vector<std::vector<std::uint32_t>> seen(wedges.point_count());  // wedges, the first of each unknown
  for (const Triangle& triangle : triangles)
    for (const std::uint32_t wedge : triangle) {
      std::vector<std::uint32_t>& known = seen[wedges.point_of(wedge)];
      const auto same = std::find_if(known.begin(), known.end(), [&](std::uint32_t other) {
        return other == wedge || first.normals[other] == first.normals[wedge];
      });
      if (same != known.end()) {
        unknowns.of_wedge[wedge] = unknowns.of_wedge[*same];
        continue;
      }
      unknowns.of_wedge[wedge] = static_cast<std::uint32_t>(unknowns.count++);
      known.push_back(wedge);
    }
  return unknowns;
}

/// Solves for the unknowns whose interpolated values at the samples are nearest to `target`, each sample weighted.
/// Every unknown is held to `start` by a millionth of its weight.
template <class Target>
Rows solve(const Unknowns& unknowns, std::span<const PlacedSample> samples, const std::vector<double>& sample_weights,
           const Target& target, const Rows& start) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(6 * samples.size());
  Rows right = Rows::Zero(unknowns.count, 3);
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(unknowns.count);
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const PlacedSample& sample = samples[s];
    const Eigen::RowVector3d wanted = target(sample).transpose();
    for (std::size_t j = 0; j < 3; ++j) {
      if (sample.weights[j] == 0) continue;
      const std::uint32_t row = unknowns.of_wedge[sample.wedges[j]];
      const double share = sample_weights[s] * sample.weights[j];
      right.row(row) += share * wanted;
      weight[row] += share;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t column = unknowns.of_wedge[sample.wedges[k]];
        if (column <= row && sample.weights[k] != 0) entries.emplace_back(row, column, share * sample.weights[k]);
      }
    }
  }
  const double mean = unknowns.count > 0 ? weight.sum() / static_cast<double>(unknowns.count) : 0;
  for (Eigen::Index i = 0; i < unknowns.count; ++i) {
    const double hold = 1e-6 * weight[i] + 1e-9 * mean;
    entries.emplace_back(i, i, hold);
    right.row(i) += hold * start.row(i);
  }
  Eigen::SparseMatrix<double> matrix(unknowns.count, unknowns.count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  if (solver.info() != Eigen::Success) return start;
  Rows solution = solver.solve(right);
  return solution.allFinite() ? solution : start;
}

/// Returns what `values` interpolate to at a sample.
Eigen::Vector3d value_at(const PlacedSample& sample, const Unknowns& unknowns, const Rows& values) {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    value += sample.weights[k] * values.row(unknowns.of_wedge[sample.wedges[k]]).transpose();
  return value;
}

template <class Value>
SampleDeviation measure(std::span<const PlacedSample> samples, const Value& value) {
  SampleDeviation deviation;
  double sum = 0, area = 0;
  for (const PlacedSample& sample : samples) {
    const double squared = (value(sample) - sample.position).squaredNorm();
    deviation.largest = std::max(deviation.largest, squared);
    sum += sample.area * squared;
    area += sample.area;
  }
  deviation.largest = std::sqrt(deviation.largest);
  deviation.rms = area > 0 ? std::sqrt(sum / area) : 0;
  return deviation;
}

/// Puts points back to `start` until no triangle has turned or shrunk too much.
void undo_folds(std::span<const Triangle> triangles, const Unknowns& points, const Rows& start, Rows& moved) {
  const auto normal_of = [&](const Triangle& t, const Rows& places) -> Eigen::Vector3d {
    const Eigen::RowVector3d a = places.row(points.of_wedge[t[0]]), b = places.row(points.of_wedge[t[1]]);
    const Eigen::RowVector3d c = places.row(points.of_wedge[t[2]]);
    return (b - a).cross(c - a).transpose();
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (const Triangle& triangle : triangles) {
      const Eigen::Vector3d before = normal_of(triangle, start), after = normal_of(triangle, moved);
      if (after.dot(before) >= least_fit_cosine * after.norm() * before.norm() &&
          after.norm() >= least_fit_area * before.norm())
        continue;
      for (const std::uint32_t wedge : triangle) {
        const std::uint32_t point = points.of_wedge[wedge];
        if (moved.row(point) == start.row(point)) continue;
        moved.row(point) = start.row(point);
        changed = true;
      }
    }
  }
}

}  // namespace

SampleDeviation deviation_of(std::span<const PlacedSample> samples, const std::vector<Eigen::Vector3f>& positions) {
  return measure(samples, [&](const PlacedSample& sample) {
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < 3; ++k) value += sample.weights[k] * positions[sample.wedges[k]].cast<double>();
    return value;
  });
}

FittedLevel fit_to_samples(const WedgeMesh& wedges, const TriangleMesh& first, std::span<const PlacedSample> samples,
                           double largest) {
  const std::vector<Triangle> triangles = wedges.triangles();
  FittedLevel fitted{first.positions, first.normals, deviation_of(samples, first.positions)};
  if (triangles.empty()) return fitted;
  const Unknowns points = points_of(wedges, triangles);
  Rows start(points.count, 3);
  for (const Triangle& triangle : triangles)
    for (const std::uint32_t wedge : triangle)
      start.row(points.of_wedge[wedge]) = first.positions[wedge].cast<double>().transpose();

  // Solve for the positions. Distances are to weigh as in the collapse, cubed, so each round weighs samples by those of
  // the round before.
  const auto distance = [&](const PlacedSample& sample, const Rows& places) {
    return (value_at(sample, points, places) - sample.position).norm();
  };
  const auto cost = [&](const Rows& places) {
    double sum = 0;
    for (const PlacedSample& sample : samples) sum += sample.area * std::pow(distance(sample, places), 3);
    return sum;
  };
  const auto measured = [&](const Rows& places) {
    return measure(samples, [&](const PlacedSample& sample) { return value_at(sample, points, places); });
  };
  Rows best = start, moved = start;
  double least = cost(start);
  std::vector<double> weights(samples.size());
  for (int round = 0; round < rounds; ++round) {
    const double floor = 0.3 * measured(moved).rms;
    for (std::size_t s = 0; s < samples.size(); ++s)
      weights[s] = samples[s].area * (round == 0 ? 1 : std::max(distance(samples[s], moved), floor));
    moved = solve(
        points, samples, weights, [](const PlacedSample& sample) { return sample.position; }, start);
    undo_folds(triangles, points, start, moved);
    if (const double found = cost(moved); found < least) {
      least = found;
      best = moved;
    }
  }
  // Go a part of the way where a sample would end too far.
  for (const double share : {1.0, 0.5, 0.25, 0.0}) {
    moved = start + share * (best - start);
    if (largest <= 0 || measured(moved).largest <= largest) break;
  }
  best = moved;

  for (const Triangle& triangle : triangles)
    for (const std::uint32_t wedge : triangle)
      fitted.positions[wedge] = best.row(points.of_wedge[wedge]).transpose().cast<float>();
  fitted.deviation = deviation_of(samples, fitted.positions);
  if (first.normals.empty()) return fitted;

  // Fit the normals to those of the samples, in units of length.
  const Unknowns normals = normals_of(wedges, first, triangles);
  Rows shading(normals.count, 3);
  for (const Triangle& triangle : triangles)
    for (const std::uint32_t wedge : triangle)
      shading.row(normals.of_wedge[wedge]) = first.normals[wedge].cast<double>().transpose();
  for (std::size_t s = 0; s < samples.size(); ++s) weights[s] = samples[s].area;
  const Rows turned = solve(
      normals, samples, weights, [](const PlacedSample& sample) { return sample.normal.normalized(); }, shading);
  for (const Triangle& triangle : triangles)
    for (const std::uint32_t wedge : triangle) {
      const Eigen::Vector3d normal = turned.row(normals.of_wedge[wedge]).transpose();
      if (normal.dot(first.normals[wedge].cast<double>()) > 0.2 * normal.norm() && normal.norm() > 0.2)
        fitted.normals[wedge] = normal.normalized().cast<float>();
    }
  return fitted;
}

}  // namespace kiln
