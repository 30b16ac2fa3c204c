// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/error_samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "base/parallel.h"
#include "raycast/ray_scene.h"
#include "report/bounce_paths.h"

namespace kiln {

namespace {

constexpr int cells_per_side = 2;  // points of a pixel along each side
constexpr std::size_t candidates_per_pixel = 16;
constexpr std::size_t fewest_candidates = 16384;

/// Marks the texels that no chart covers, and those beside one: the ones that gutters and seams change.
std::vector<std::uint8_t> border_texels(const DetailMaps* maps) {
  if (maps == nullptr) return {};
  const DetailMaps& detail = *maps;
  std::vector<std::uint8_t> border(detail.covered.size());
  for (int j = 0; j < detail.height; ++j)
    for (int i = 0; i < detail.width; ++i)
      for (int y = std::max(0, j - 1); y <= std::min(detail.height - 1, j + 1); ++y)
        for (int x = std::max(0, i - 1); x <= std::min(detail.width - 1, i + 1); ++x)
          if (detail.covered[static_cast<std::size_t>(y * detail.width + x)] == 0)
            border[static_cast<std::size_t>(j * detail.width + i)] = 1;
  return border;
}

/// Point of the low mesh that a viewer sees, that of the high mesh seen in its place, and the one it stands for.
struct SeenPoint {
  SurfacePoint low, seen, stood;
};

/// Pixel as a viewer sees it.
struct Candidate {
  std::array<SeenPoint, cells_per_side * cells_per_side> points;
  int count = 0;          ///< of points; 0 where one is missing
  double importance = 0;  ///< how large its error may be, as a guess from rays and normals alone
};

/// Place of the low mesh and a view of it, as random numbers of 0 to 1 say them.
struct Draw {
  std::uint32_t triangle;
  float u, v;                   // barycentric
  float squared_sine, turn;     // of the view
  Eigen::Vector2f shift{0, 0};  // of a pixel's points, in cells
};

/// Draws places evenly by area, with views by the cosine: every part of the surface is seen as large as it is.
std::vector<Draw> draw_places(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed) {
  std::vector<double> areas;
  for (const Triangle& t : mesh.triangles) areas.push_back(area_normal(mesh, t).norm());
  std::mt19937 random(static_cast<std::mt19937::result_type>(seed));
  std::discrete_distribution<std::uint32_t> triangle(areas.begin(), areas.end());
  std::uniform_real_distribution<float> number(0, 1);
  std::vector<Draw> draws(count);
  for (Draw& draw : draws) {
    const float root = std::sqrt(number(random)), share = number(random);
    draw.triangle = triangle(random);
    draw.u = root * (1 - share);
    draw.v = root * share;
    draw.squared_sine = number(random);
    draw.turn = number(random);
    draw.shift.x() = number(random);
    draw.shift.y() = number(random);
  }
  return draws;
}

/// Makes the samples of one asset.
class Sampler {
 public:
  Sampler(const TriangleMesh& high, const TriangleMesh& low, const DetailMaps* detail, const ErrorSampling& sampling)
      : high_(high),
        low_(low),
        detail_(detail),
        sampling_(sampling),
        high_rays_(high),
        low_rays_(low),
        border_(border_texels(detail)) {
    const float diagonal = bounding_box(high).sides().norm();
    reach_ = std::max(0.05f * diagonal, static_cast<float>(sampling.pixel_size));
    distance_ = diagonal + bounding_box(low).sides().norm() + reach_;
    offset_ = 1e-4f * 0.05f * diagonal;
    apart_ = 0.005f * diagonal;
  }

  ErrorSamples make() {
    const std::size_t wanted = sampling_.pixels;
    const std::vector<Draw> draws =
        draw_places(low_, std::max(candidates_per_pixel * wanted, fewest_candidates), sampling_.seed);
    std::vector<Candidate> candidates(draws.size());
    parallel_for(std::size_t{0}, draws.size(), 256, [&](std::size_t k) {
      candidates[k] = candidate_of(draws[k]);
      if (candidates[k].count > 0) candidates[k].importance = importance_of(candidates[k]);
    });
    double importances = 0;
    for (const Candidate& candidate : candidates) importances += candidate.importance;
    // Choose a candidate whenever the sum passes a step, so each by its share; one of more than a step is always
    // chosen.
    const double step = importances / static_cast<double>(wanted);
    double sum = 0.5 * step;
    for (const Candidate& candidate : candidates) {
      sum += candidate.importance;
      if (candidate.count == 0 || sum < step) continue;
      sum = std::fmod(sum, step);
      add(candidate);
      samples_.pixel_weights.push_back(std::max(1.0, step / candidate.importance));
    }
    return std::move(samples_);
  }

 private:
  Candidate candidate_of(const Draw& draw) const {
    const SurfacePoint place{draw.triangle, draw.u, draw.v, 0};
    const Eigen::Vector3f middle = position_at(low_, place);
    const Eigen::Vector3f view = cosine_direction(normal_at(low_, place), draw.squared_sine, draw.turn);
    Candidate candidate;
    if (low_rays_.first_hit(middle + offset_ * normal_at(low_, place), view, 0, infinity).found()) return candidate;
    if (sampling_.pixel_size <= 0) {
      add_seen(candidate, place, view);
      return candidate;
    }
    const Eigen::Vector3f across = view.unitOrthogonal(), along = view.cross(across);
    const auto size = static_cast<float>(sampling_.pixel_size);
    for (int k = 0; k < cells_per_side * cells_per_side; ++k) {
      const Eigen::Vector2f cell(static_cast<float>(k % cells_per_side), static_cast<float>(k / cells_per_side));
      const Eigen::Vector2f at = size * ((cell + draw.shift) / cells_per_side - Eigen::Vector2f::Constant(0.5f));
      add_seen(candidate, first_seen(low_rays_, middle + at.x() * across + at.y() * along, view), view);
      if (candidate.count == 0) return candidate;
    }
    return candidate;
  }

  /// Adds a point of the low mesh to a candidate, or empties the candidate where either mesh is not seen from its
  /// front, or where the point stands for none.
  void add_seen(Candidate& candidate, const SurfacePoint& low, const Eigen::Vector3f& view) const {
    const auto fronts = [&](const TriangleMesh& mesh, const SurfacePoint& point) {
      return point.found() && normal_at(mesh, point).dot(view) > 0;
    };
    candidate.count = fronts(low_, low) ? candidate.count + 1 : 0;
    if (candidate.count == 0) return;
    const Eigen::Vector3f position = position_at(low_, low);
    SeenPoint& point = candidate.points[static_cast<std::size_t>(candidate.count - 1)];
    point.low = low;
    point.seen = first_seen(high_rays_, position, view);
    if (fronts(high_, point.seen))
      point.stood = high_rays_.closest_facing_point(position, normal_at(low_, low), reach_);
    if (!point.stood.found()) candidate.count = 0;
  }

  /// Guesses how large the error of a candidate's pixel may be, relative to others.
  double importance_of(const Candidate& candidate) const {
    Eigen::Vector3f turned = Eigen::Vector3f::Zero();
    bool at_outline = false;
    for (int k = 0; k < candidate.count; ++k) {
      const SeenPoint& point = candidate.points[static_cast<std::size_t>(k)];
      turned += normal_at(high_, point.seen) - normal_at(high_, point.stood);
      at_outline = at_outline || (position_at(high_, point.seen) - position_at(high_, point.stood)).norm() > apart_;
    }
    return 0.02 + double{turned.norm()} / candidate.count + (at_outline ? 0.3 : 0.0);
  }

  /// Returns the point of a mesh that a viewer in direction `view` sees on the line through `position`.
  SurfacePoint first_seen(const RayScene& rays, const Eigen::Vector3f& position, const Eigen::Vector3f& view) const {
    return rays.first_hit(position + distance_ * view, -view, 0, infinity);
  }

  Lookup vertex_lookup_at(const SurfacePoint& low) const {
    const Triangle& t = low_.triangles[low.triangle];
    return {{t[0], t[1], t[2], t[2]}, {1 - low.u - low.v, low.u, low.v, 0}};
  }

  Lookup lookup_at(const SurfacePoint& low) const {
    if (detail_ == nullptr) return vertex_lookup_at(low);
    const int width = detail_->width, height = detail_->height;
    const Eigen::Vector2f uv = interpolate(low_, low_.uvs, low);
    const float x = uv.x() * static_cast<float>(width) - 0.5f, y = uv.y() * static_cast<float>(height) - 0.5f;
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    const float s = x - static_cast<float>(i), t = y - static_cast<float>(j);
    Lookup lookup;
    for (std::size_t k = 0; k < 4; ++k) {
      const int column = std::clamp(i + static_cast<int>(k % 2), 0, width - 1),
                row = std::clamp(j + static_cast<int>(k / 2), 0, height - 1);
      lookup.slots[k] = static_cast<std::uint32_t>(row * width + column);
      lookup.weights[k] = (k % 2 == 0 ? 1 - s : s) * (k / 2 == 0 ? 1 - t : t);
      lookup.at_border = lookup.at_border || border_[lookup.slots[k]] != 0;
    }
    return lookup;
  }

  void add(const Candidate& candidate) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(candidate.count); ++k) {
      const auto& [low, seen, stood] = candidate.points[k];
      samples_.seen_positions.push_back(position_at(high_, seen));
      samples_.seen_normals.push_back(normal_at(high_, seen));
      samples_.stood_positions.push_back(position_at(high_, stood));
      samples_.stood_normals.push_back(normal_at(high_, stood));
      samples_.seen.push_back(seen);
      samples_.stood.push_back(stood);
      if (!low_.uvs.empty()) samples_.uvs.push_back(interpolate(low_, low_.uvs, low));
      samples_.lookups.push_back(lookup_at(low));
      samples_.vertex_lookups.push_back(vertex_lookup_at(low));
    }
    samples_.pixel_ends.push_back(samples_.points());
  }

  static constexpr float infinity = std::numeric_limits<float>::infinity();

  const TriangleMesh& high_;
  const TriangleMesh& low_;
  const DetailMaps* const detail_;
  const ErrorSampling& sampling_;
  const RayScene high_rays_, low_rays_;
  const std::vector<std::uint8_t> border_;
  float reach_ = 0;     ///< how far the point of the high mesh that a texel stands for is looked for
  float distance_ = 0;  ///< of the viewer, who stands outside both meshes
  float offset_ = 0;    ///< start of a view off the low mesh
  float apart_ = 0;     ///< distance of the points seen of both meshes from which on an outline is between
  ErrorSamples samples_;
};

}  // namespace

std::vector<std::uint32_t> slots_of(const std::vector<Lookup>& lookups) {
  std::vector<std::uint32_t> all;
  for (const Lookup& lookup : lookups) all.insert(all.end(), lookup.slots.begin(), lookup.slots.end());
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

ErrorSamples make_error_samples(const TriangleMesh& high, const TriangleMesh& low, const DetailMaps* detail,
                                const ErrorSampling& sampling) {
  return Sampler(high, low, detail, sampling).make();
}

}  // namespace kiln
