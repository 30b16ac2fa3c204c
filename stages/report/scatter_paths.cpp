// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/scatter_paths.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "base/parallel.h"
#include "mesh/surface_point.h"
#include "sh/basis.h"

namespace kiln {

namespace {

constexpr int bins = 128;
constexpr double kept_share = 0.999;  // of the light of a plane
constexpr float least_reach = 200;    // roundings; what scatters less far leaves where it entered
constexpr float certain_share =
    0.25f;  // of a line's light: points that bring less may be left out ("Russian roulette")
constexpr std::size_t block_receivers = 64;
constexpr std::array<float, 3> axis_weights = {0.5f, 0.25f, 0.25f};  // of the normal and two tangents [King 2013]
constexpr float pi = std::numbers::pi_v<float>;

/// Returns the radius, mm, within which a profile has `amount` of its light; below total().
double radius_within(const ScatterProfile& profile, double amount) {
  double low = -12, high = 12;  // decimal logarithms
  for (int step = 0; step < 60; ++step) {
    const double middle = (low + high) / 2;
    (profile.within(std::pow(10, middle)) < amount ? low : high) = middle;
  }
  return std::pow(10, high);
}

/// Returns a point of a mesh minus `position`, as exactly as floats hold the difference: a mean free path may be a
/// hundred-thousandth of the mesh.
Eigen::Vector3f offset_to(const TriangleMesh& mesh, const SurfacePoint& point, const Eigen::Vector3f& position) {
  const Triangle& t = mesh.triangles[point.triangle];
  return weigh_corners<Eigen::Vector3f>(
      point, [&](std::size_t k) -> Eigen::Vector3f { return mesh.positions[t[k]] - position; });
}

/// Additive sequence of low discrepancy in `dimensions` dimensions, which a random shift makes even over the unit cube
/// ([Roberts 2018]; [Cranley 1976]).
template <std::size_t dimensions>
class ShiftedSequence {
 public:
  explicit ShiftedSequence(PathRandom& random) {
    for (float& shift : shifts_) shift = random.uniform();
  }

  std::array<float, dimensions> at(std::size_t k) const {
    std::array<float, dimensions> numbers;
    double step = 1;
    for (std::size_t d = 0; d < dimensions; ++d) {
      step /= root();
      const double number = shifts_[d] + step * static_cast<double>(k + 1);
      numbers[d] = std::min(static_cast<float>(number - std::floor(number)), std::nextafter(1.f, 0.f));
    }
    return numbers;
  }

 private:
  /// Returns the root of x^(d + 1) = x + 1, d dimensions.
  static double root() {
    static const double found = [] {
      double x = 2;
      for (int step = 0; step < 60; ++step) x = std::pow(1 + x, 1 / (static_cast<double>(dimensions) + 1));
      return x;
    }();
    return found;
  }

  std::array<float, dimensions> shifts_;
};

}  // namespace

float ScatterPaths::Radii::sample(float number) const {
  const float place = number * bins;
  const auto bin = std::min(static_cast<std::size_t>(place), static_cast<std::size_t>(bins - 1));
  return bounds[bin] + (place - static_cast<float>(bin)) * (bounds[bin + 1] - bounds[bin]);
}

float ScatterPaths::Radii::density(float radius) const {
  if (bounds.empty() || radius >= bounds.back()) return 0;
  const auto above = std::ranges::upper_bound(bounds, radius);
  return 1 / (bins * (*above - *(above - 1)) * 2 * pi * std::max(radius, std::numeric_limits<float>::min()));
}

ScatterPaths::Radii ScatterPaths::radii_of(const ScatterProfile& profile, double mm_per_unit) {
  Radii radii{profile, {}};
  if (profile.total() <= 0) return radii;
  radii.bounds.push_back(0);
  for (int bin = 1; bin <= bins; ++bin) {
    const double radius = radius_within(profile, kept_share * profile.total() * bin / bins) / mm_per_unit;
    radii.bounds.push_back(std::max(static_cast<float>(radius), std::nextafter(radii.bounds.back(), 1.f)));
  }
  return radii;
}

ScatterPaths::ScatterPaths(const TriangleMesh& mesh, std::span<const ScatterProfile> profiles, double mm_per_unit)
    : mesh_(mesh),
      own_(mesh),
      diameter_(bounding_box(mesh).sides().norm()),
      rounding_(2e-7f * diameter_),
      mm_per_unit_(mm_per_unit) {
  if (profiles.size() != 1 && profiles.size() != 3) throw std::invalid_argument("ScatterPaths: one profile or three");
  for (std::size_t c = 0; c < colors_.size(); ++c) {
    colors_[c] = radii_of(profiles[profiles.size() == 1 ? 0 : c], mm_per_unit);
    if (colors_[c].bounds.empty()) continue;
    if (colors_[c].bounds.back() > least_reach * rounding_)
      sampled_colors_.push_back(c);
    else
      total_here_[static_cast<Eigen::Index>(c)] = static_cast<float>(colors_[c].profile.total());
  }
}

void ScatterPaths::enter(const Eigen::Vector3f& position, const Eigen::Vector3f& normal, int lines, PathRandom& random,
                         ScatterEntries& entries) const {
  const Eigen::Vector3f tangent = normal.unitOrthogonal();
  const std::array<Eigen::Vector3f, 3> axes = {normal, tangent, normal.cross(tangent)};
  const ShiftedSequence<4> sequence(random);
  for (int line = 0; line < lines && total_here_.maxCoeff() > 0; ++line) {
    entries.positions.push_back(position);
    entries.normals.push_back(normal);
    entries.weights.emplace_back(total_here_ / static_cast<float>(lines));
  }
  for (int line = 0; line < lines && !sampled_colors_.empty(); ++line) {
    // Step 1: choose a line.
    const auto [of_axis, of_color, of_radius, of_turn] = sequence.at(static_cast<std::size_t>(line));
    const std::size_t a = of_axis < axis_weights[0] ? 0 : of_axis < axis_weights[0] + axis_weights[1] ? 1 : 2;
    const auto color = static_cast<std::size_t>(of_color * static_cast<float>(sampled_colors_.size()));
    const float radius = colors_[sampled_colors_[color]].sample(of_radius), turn = 2 * pi * of_turn;
    const Eigen::Vector3f origin = position +
                                   radius * (std::cos(turn) * axes[(a + 1) % 3] + std::sin(turn) * axes[(a + 2) % 3]) +
                                   diameter_ * axes[a];

    // Step 2: take all points in which it meets the surface.
    float nearest = 0;
    for (;;) {
      const SurfacePoint hit = own_.first_hit(origin, -axes[a], nearest, 2 * diameter_);
      if (!hit.found()) break;
      nearest = hit.distance + 1e-6f * diameter_;
      const Eigen::Vector3f face = face_normal(mesh_, hit.triangle);
      const Eigen::Vector3f offset = offset_to(mesh_, hit, position);
      const float distance = std::max(offset.norm(), rounding_);
      float density = 0;  // by area of the surface, of any line
      for (std::size_t k = 0; k < 3; ++k) {
        const float from_axis = std::max((offset - offset.dot(axes[k]) * axes[k]).norm(), rounding_);
        for (const std::size_t c : sampled_colors_)
          density += axis_weights[k] * std::abs(face.dot(axes[k])) * colors_[c].density(from_axis) /
                     static_cast<float>(sampled_colors_.size());
      }
      if (!(density > 0)) continue;
      Eigen::Vector3f weight = Eigen::Vector3f::Zero();
      for (const std::size_t c : sampled_colors_)
        if (distance < colors_[c].bounds.back())
          weight[static_cast<Eigen::Index>(c)] =
              static_cast<float>(colors_[c].profile.density(distance * mm_per_unit_) * mm_per_unit_ * mm_per_unit_ /
                                 (double{density} * lines));
      // Step 3: keep all points that matter, and of the others some, by chance, in the place of the rest.
      const float share = weight.maxCoeff() * static_cast<float>(lines);
      if (share < certain_share) {
        if (share <= certain_share * random.uniform()) continue;
        weight *= certain_share / share;
      }
      entries.positions.emplace_back(position + offset);
      entries.normals.push_back(normal_at(mesh_, hit));
      entries.weights.push_back(weight);
    }
  }
}

ScatterEntries ScatterPaths::entries(const Receivers& receivers, int lines,
                                     std::span<const std::uint64_t> numbers) const {
  ScatterEntries all;
  const std::size_t blocks = (receivers.size() + block_receivers - 1) / block_receivers;
  std::vector<ScatterEntries> parts(blocks);
  parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    const std::size_t end = std::min(receivers.size(), (block + 1) * block_receivers);
    for (std::size_t r = block * block_receivers; r < end; ++r) {
      PathRandom random(2 * numbers[r]);
      enter(receivers.positions[r], receivers.normals[r], lines, random, parts[block]);
      parts[block].ends.push_back(parts[block].positions.size());
    }
  });
  for (const ScatterEntries& part : parts) {
    const std::size_t before = all.positions.size();
    all.positions.insert(all.positions.end(), part.positions.begin(), part.positions.end());
    all.normals.insert(all.normals.end(), part.normals.begin(), part.normals.end());
    all.weights.insert(all.weights.end(), part.weights.begin(), part.weights.end());
    for (const std::size_t end : part.ends) all.ends.push_back(before + end);
  }
  return all;
}

void add_scattered(const ScatterEntries& entries, const PathWalker& walker, std::span<const std::uint64_t> numbers,
                   std::vector<TransferVectors>& channels, std::vector<TransferVectors>& direct) {
  const int coefficients = channels.front().coefficients;
  const ShBasis basis(band_of(coefficients - 1) + 1);
  parallel_ranges(0, entries.ends.size(), block_receivers, [&](std::size_t begin, std::size_t end) {
    std::vector<float> row(static_cast<std::size_t>(coefficients));
    Eigen::ArrayXXd all(coefficients, 3), unbounced(coefficients, 3);
    for (std::size_t r = begin; r != end; ++r) {
      PathRandom random(2 * numbers[r] + 1);
      const ShiftedSequence<2> sequence(random);
      all.setZero();
      unbounced.setZero();
      for (std::size_t k = entries.begin(r); k < entries.ends[r]; ++k) {
        const Eigen::Vector3f& normal = entries.normals[k];
        const auto [squared_sine, turn] = sequence.at(k - entries.begin(r));
        // A direction by the cosine has the density cosine / pi, so the path alone is the transfer.
        const std::optional<Escape> escape = walker.walk(entries.positions[k] + walker.ray_offset() * normal,
                                                         cosine_direction(normal, squared_sine, turn), random);
        if (!escape) continue;
        basis.evaluate<float>(escape->direction, row);
        const auto arrived = Eigen::Map<const Eigen::ArrayXf>(row.data(), coefficients).cast<double>();
        for (int c = 0; c < 3; ++c) {
          const double weight = double{entries.weights[k][c]} * escape->throughput[c];
          all.col(c) += weight * arrived;
          if (escape->bounces == 0) unbounced.col(c) += weight * arrived;
        }
      }
      for (int c = 0; c < 3; ++c)
        for (int i = 0; i < coefficients; ++i) {
          channels[static_cast<std::size_t>(c)].plane(i)[r] += static_cast<float>(all(i, c));
          direct[static_cast<std::size_t>(c)].plane(i)[r] += static_cast<float>(unbounced(i, c));
        }
    }
  });
}

}  // namespace kiln
