// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/error_samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "mesh/surface_point.h"
#include "raycast/ray_scene.h"
#include "report/bounce_paths.h"

namespace kiln {

namespace {

constexpr int cells_per_side = 2;  // points of a pixel along each side

/// Marks the texels that no chart covers, and those beside one: the ones that gutters and seams change.
std::vector<std::uint8_t> border_texels(const DetailMaps& detail) {
  std::vector<std::uint8_t> border(detail.covered.size());
  for (int j = 0; j < detail.height; ++j)
    for (int i = 0; i < detail.width; ++i)
      for (int y = std::max(0, j - 1); y <= std::min(detail.height - 1, j + 1); ++y)
        for (int x = std::max(0, i - 1); x <= std::min(detail.width - 1, i + 1); ++x)
          if (detail.covered[static_cast<std::size_t>(y * detail.width + x)] == 0)
            border[static_cast<std::size_t>(j * detail.width + i)] = 1;
  return border;
}

/// Makes the samples of one asset.
class Sampler {
 public:
  Sampler(const TriangleMesh& high, const TriangleMesh& low, const DetailMaps& detail, const ErrorSampling& sampling)
      : high_(high),
        low_(low),
        detail_(detail),
        sampling_(sampling),
        high_rays_(high),
        low_rays_(low),
        border_(border_texels(detail)) {
    const float diagonal = bounding_box(high).sides().norm();
    reach_ = std::max(0.05f * diagonal, static_cast<float>(sampling.pixel_size));
    offset_ = 1e-4f * 0.05f * diagonal;
  }

  ErrorSamples make() {
    std::vector<double> areas;
    for (const Triangle& t : low_.triangles) areas.push_back(area_normal(low_, t).norm());
    std::mt19937 random(static_cast<std::mt19937::result_type>(sampling_.seed));
    std::discrete_distribution<std::uint32_t> triangle(areas.begin(), areas.end());
    std::uniform_real_distribution<float> number(0, 1);
    // Some views are blocked, by a third at most on scans; give up after many.
    for (std::size_t tries = 0; samples_.pixels() < sampling_.pixels && tries < 8 * sampling_.pixels; ++tries) {
      const float root = std::sqrt(number(random)), share = number(random);
      const SurfacePoint place{triangle(random), root * (1 - share), root * share, 0};
      // By the cosine: every part of the surface is seen as large as it is.
      const float squared_sine = number(random), turn = number(random);
      const Eigen::Vector3f view = cosine_direction(normal_at(low_, place), squared_sine, turn);
      if (!is_visible(place, view)) continue;
      if (sampling_.pixel_size > 0) {
        const float column = number(random), row = number(random);
        add_pixel(position_at(low_, place), view, {column, row});
      } else {
        add_point(place, view);
      }
      if (samples_.points() > (samples_.pixel_ends.empty() ? 0 : samples_.pixel_ends.back()))
        samples_.pixel_ends.push_back(samples_.points());
    }
    return std::move(samples_);
  }

 private:
  bool is_visible(const SurfacePoint& place, const Eigen::Vector3f& view) const {
    const Eigen::Vector3f origin = position_at(low_, place) + offset_ * normal_at(low_, place);
    return !low_rays_.first_hit(origin, view, 0, std::numeric_limits<float>::infinity()).found();
  }

  Lookup lookup_at(const Eigen::Vector2f& uv) const {
    const float x = uv.x() * static_cast<float>(detail_.width) - 0.5f,
                y = uv.y() * static_cast<float>(detail_.height) - 0.5f;
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    const float s = x - static_cast<float>(i), t = y - static_cast<float>(j);
    Lookup lookup;
    for (int k = 0; k < 4; ++k) {
      const int column = std::clamp(i + k % 2, 0, detail_.width - 1),
                row = std::clamp(j + k / 2, 0, detail_.height - 1);
      lookup.texels[k] = static_cast<std::uint32_t>(row * detail_.width + column);
      lookup.weights[k] = (k % 2 == 0 ? 1 - s : s) * (k / 2 == 0 ? 1 - t : t);
      lookup.at_border = lookup.at_border || border_[lookup.texels[k]] != 0;
    }
    return lookup;
  }

  /// Adds the points of a pixel around `position`, on a lattice shifted by `shift`, 0 to 1, of its cells.
  void add_pixel(const Eigen::Vector3f& position, const Eigen::Vector3f& view, const Eigen::Vector2f& shift) {
    const Eigen::Vector3f across = view.unitOrthogonal(), along = view.cross(across);
    const auto size = static_cast<float>(sampling_.pixel_size);
    for (int k = 0; k < cells_per_side * cells_per_side; ++k) {
      const Eigen::Vector2f cell(static_cast<float>(k % cells_per_side), static_cast<float>(k / cells_per_side));
      const Eigen::Vector2f place = size * ((cell + shift) / cells_per_side - Eigen::Vector2f::Constant(0.5f));
      const Eigen::Vector3f eye = position + place.x() * across + place.y() * along + reach_ * view;
      const SurfacePoint hit = low_rays_.first_hit(eye, -view, 0, 2 * reach_);
      if (hit.found() && normal_at(low_, hit).dot(view) > 0) add_point(hit, view);
    }
  }

  /// Adds a point of the low mesh, unless the high mesh is not found there.
  void add_point(const SurfacePoint& place, const Eigen::Vector3f& view) {
    const Eigen::Vector3f position = position_at(low_, place);
    const SurfacePoint stood = high_rays_.closest_facing_point(position, normal_at(low_, place), reach_);
    const SurfacePoint seen = high_rays_.first_hit(position + reach_ * view, -view, 0, 2 * reach_);
    if (!stood.found() || !seen.found() || normal_at(high_, seen).dot(view) <= 0) return;
    samples_.seen_positions.push_back(position_at(high_, seen));
    samples_.seen_normals.push_back(normal_at(high_, seen));
    samples_.stood_positions.push_back(position_at(high_, stood));
    samples_.stood_normals.push_back(normal_at(high_, stood));
    samples_.lookups.push_back(lookup_at(interpolate(low_, low_.uvs, place)));
  }

  const TriangleMesh& high_;
  const TriangleMesh& low_;
  const DetailMaps& detail_;
  const ErrorSampling& sampling_;
  const RayScene high_rays_, low_rays_;
  const std::vector<std::uint8_t> border_;
  float reach_ = 0;   ///< how far the high mesh is looked for
  float offset_ = 0;  ///< start of a view off the low mesh
  ErrorSamples samples_;
};

}  // namespace

std::vector<std::uint32_t> ErrorSamples::texels() const {
  std::vector<std::uint32_t> all;
  for (const Lookup& lookup : lookups) all.insert(all.end(), lookup.texels.begin(), lookup.texels.end());
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

ErrorSamples make_error_samples(const TriangleMesh& high, const TriangleMesh& low, const DetailMaps& detail,
                                const ErrorSampling& sampling) {
  return Sampler(high, low, detail, sampling).make();
}

}  // namespace kiln
