// SPDX-License-Identifier: GPL-3.0-or-later
// Transfer from distant light to light that arrives at points in space: the neighbourhood transfer of [Sloan 2002],
// section 6, by rays that start at the point.
#include "probes/probes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numbers>

#include "base/json.h"
#include "base/parallel.h"
#include "mesh/winding.h"
#include "raycast/ray_scene.h"
#include "sh/basis.h"
#include "sh/directions.h"

namespace kiln {

namespace {

using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
constexpr Eigen::Index block = 256;  // directions whose rows are multiplied at once
constexpr double inside_winding = 0.5;
constexpr std::size_t group_points = 64;  // points between two reports of progress
static_assert(most_grid_points == most_probes);

/// Returns one row of basis functions for each direction.
Rows basis_rows(const std::vector<Eigen::Vector3f>& directions, int bands) {
  const ShBasis basis(bands);
  Rows rows(static_cast<Eigen::Index>(directions.size()), basis.size());
  for (std::size_t d = 0; d < directions.size(); ++d)
    basis.evaluate<float>(directions[d], std::span(rows.row(static_cast<Eigen::Index>(d)).data(),
                                                   static_cast<std::size_t>(basis.size())));
  return rows;
}

/// Returns a^T b, with blocks added in float64.
Eigen::MatrixXd product(const Rows& a, const Rows& b, Eigen::Index count) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(a.cols(), b.cols());
  for (Eigen::Index first = 0; first < count; first += block) {
    const Eigen::Index size = std::min(block, count - first);
    const Eigen::MatrixXf part = a.middleRows(first, size).transpose() * b.middleRows(first, size);
    sum += part.cast<double>();
  }
  return sum;
}

/// Computes what each point, one after another, sees around it.
class Looker {
 public:
  Looker(const TriangleMesh& mesh, const SurfaceLight& light, int bands, const ProbesSettings& settings, int seed)
      : light_(light),
        positions_(light.values.empty() ? mesh.positions : light.cache.positions),
        triangles_(light.values.empty() ? mesh.triangles : light.cache.triangles),
        scene_(positions_, triangles_),
        directions_(sample_directions(settings.sampling, settings.directions, static_cast<std::uint64_t>(seed))),
        rows_(basis_rows(directions_, bands)),
        weight_(4 * std::numbers::pi / static_cast<double>(directions_.size())),
        surplus_(Eigen::MatrixXd::Identity(rows_.cols(), rows_.cols()) -
                 weight_ * product(rows_, rows_, rows_.rows())) {}

  /// Writes the channels' matrices; returns the open share of the sky.
  double look(const Eigen::Vector3f& point, int channels, float* matrices) const {
    const Eigen::Index size = rows_.cols();
    const int sent_width = light_.values.empty() ? 0 : channels * static_cast<int>(size);
    Rows open(rows_.rows(), size), seeing(sent_width > 0 ? rows_.rows() : 0, size), seen(seeing.rows(), sent_width);
    Eigen::Index open_count = 0, seen_count = 0;
    for (Eigen::Index d = 0; d < rows_.rows(); ++d) {
      const Eigen::Vector3f& direction = directions_[static_cast<std::size_t>(d)];
      const SurfacePoint hit = scene_.first_hit(point, direction, 0.f, std::numeric_limits<float>::infinity());
      if (!hit.found()) {
        open.row(open_count++) = rows_.row(d);
      } else if (sent_width > 0 && shows_front(hit, direction)) {
        seeing.row(seen_count) = rows_.row(d);
        seen.row(seen_count++) = sent_from(hit, sent_width);
      }
    }
    const double share = static_cast<double>(open_count) / static_cast<double>(rows_.rows());
    const Eigen::MatrixXd sky = weight_ * product(open, open, open_count) + share * surplus_;
    const Eigen::MatrixXd surface = weight_ * product(seeing, seen, seen_count);
    for (int c = 0; c < channels; ++c) {
      Eigen::Map<Rows> matrix(matrices + c * size * size, size, size);
      matrix = sky.cast<float>();
      if (sent_width > 0) matrix += surface.middleCols(c * size, size).cast<float>();
    }
    return share;
  }

 private:
  bool shows_front(const SurfacePoint& hit, const Eigen::Vector3f& direction) const {
    const auto& [a, b, c] = triangles_[hit.triangle];
    const Eigen::Vector3f &p = positions_[a], &q = positions_[b], &r = positions_[c];
    return (q - p).cross(r - p).dot(direction) < 0;
  }

  Eigen::RowVectorXf sent_from(const SurfacePoint& hit, int width) const {
    const std::array<std::uint32_t, 3>& corners = light_.cache.points[hit.triangle];
    return weigh_corners<Eigen::RowVectorXf>(hit, [&](std::size_t k) {
      return Eigen::Map<const Eigen::RowVectorXf>(light_.values.data() + std::size_t{corners[k]} * width, width);
    });
  }

  const SurfaceLight& light_;
  std::span<const Eigen::Vector3f> positions_;
  std::span<const Triangle> triangles_;
  RayScene scene_;
  std::vector<Eigen::Vector3f> directions_;
  Rows rows_;
  double weight_;
  Eigen::MatrixXd surplus_;  // difference of the sum over the whole sphere from the identity
};

}  // namespace

std::size_t ProbesResult::invalid() const {
  return static_cast<std::size_t>(std::count(probes.valid.begin(), probes.valid.end(), 0));
}

Json ProbesResult::to_json() const {
  return {{"points", probes.positions.size()},
          {"invalid", invalid()},
          {"channels", probes.channels},
          {"coefficients", probes.coefficients()},
          {"open_share", open_share},
          {"bounces", bounces},
          {"last_bounce_share", last_bounce_share},
          {"surface_points", surface_points}};
}

ProbeSet place_probes(const TriangleMesh& mesh, const std::vector<Eigen::Vector3f>& points,
                      const ProbesSettings& settings) {
  ProbeSet probes;
  probes.bands = settings.bands;
  probes.positions = points;
  if (!points.empty()) return probes;
  BoundingBox box;
  if (const auto given = settings.box) {
    box = {Eigen::Vector3f((*given)[0], (*given)[1], (*given)[2]),
           Eigen::Vector3f((*given)[3], (*given)[4], (*given)[5])};
  } else {
    box = bounding_box(mesh.positions);
    const float margin = box.sides().maxCoeff() / 2;
    box.lowest.array() -= margin;
    box.highest.array() += margin;
  }
  probes.grid = ProbeGrid{settings.grid, box.lowest, box.highest};
  for (std::size_t k = 0; k < probes.grid->count(); ++k) probes.positions.push_back(probes.grid->position(k));
  return probes;
}

ProbesResult probe_matrices(const TriangleMesh& mesh, const SurfaceLight& light, ProbeSet probes,
                            const ProbesSettings& settings, int seed, const ProgressFunction& progress) {
  const BoundingBox box = bounding_box(mesh.positions);  // outside of it the mesh goes around no point
  probes.channels = light.channels;
  const std::size_t count = probes.positions.size();
  probes.valid.assign(count, 1);
  probes.matrices.assign(count * probes.entries(), 0.f);
  const Looker looker(mesh, light, probes.bands, settings, seed);
  std::vector<double> open(count, 0);
  for (std::size_t first = 0; first < count; first += group_points) {
    parallel_for(first, std::min(count, first + group_points), [&](std::size_t k) {
      const Eigen::Vector3f& point = probes.positions[k];
      if (box.contains(point) && winding_number(mesh, point.cast<double>()) > inside_winding)
        probes.valid[k] = 0;
      else
        open[k] = looker.look(point, probes.channels, probes.matrices.data() + k * probes.entries());
    });
    progress(static_cast<double>(std::min(count, first + group_points)) / static_cast<double>(count));
  }

  ProbesResult result;
  result.bounces = light.bounces;
  result.last_bounce_share = light.last_share;
  result.surface_points = light.cache.size();
  for (std::size_t k = 0; k < count; ++k) result.open_share += open[k];
  result.probes = std::move(probes);
  if (const std::size_t valid = count - result.invalid(); valid > 0) result.open_share /= static_cast<double>(valid);
  return result;
}

}  // namespace kiln
