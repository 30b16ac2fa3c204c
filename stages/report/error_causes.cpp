// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/error_causes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <span>

#include "base/json.h"
#include "mesh/surface_point.h"
#include "raycast/ray_scene.h"
#include "raycast/ray_transfer.h"
#include "report/bounce_paths.h"
#include "sh/basis.h"
#include "sh/light_prior.h"
#include "sh/ray_offset.h"

namespace kiln {

namespace {

constexpr std::size_t sample_count = 4096;
constexpr int fewest_reference_directions = 4096;
constexpr int most_reference_directions = 65536;
constexpr int fewest_reference_bands = 16;

/// Texels around a place of the texture, with their weights in a bilinear lookup.
struct Lookup {
  std::array<std::uint32_t, 4> texels;
  std::array<float, 4> weights;
  bool at_border = false;  ///< whether one of them is covered by no chart
};

/// Points at which errors are measured.
struct Samples {
  std::vector<Eigen::Vector3f> seen_positions, seen_normals;    ///< where the viewer's ray meets the high mesh
  std::vector<Eigen::Vector3f> stood_positions, stood_normals;  ///< points that those of the low mesh stand for
  std::vector<Lookup> lookups;
};

Lookup lookup_at(const Eigen::Vector2f& uv, const DetailMaps& detail) {
  const float x = uv.x() * static_cast<float>(detail.width) - 0.5f,
              y = uv.y() * static_cast<float>(detail.height) - 0.5f;
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  const float s = x - static_cast<float>(i), t = y - static_cast<float>(j);
  Lookup lookup;
  for (int k = 0; k < 4; ++k) {
    const int column = std::clamp(i + k % 2, 0, detail.width - 1), row = std::clamp(j + k / 2, 0, detail.height - 1);
    lookup.texels[k] = static_cast<std::uint32_t>(row * detail.width + column);
    lookup.weights[k] = (k % 2 == 0 ? 1 - s : s) * (k / 2 == 0 ? 1 - t : t);
    lookup.at_border = lookup.at_border || detail.covered[lookup.texels[k]] == 0;
  }
  return lookup;
}

/// Returns the points of the high mesh that a point of the low one is seen as and stands for; false where a viewer from
/// there does not see that point.
bool add_sample(const SplitInput& input, const RayScene& high, const RayScene& low, const SurfacePoint& place,
                const Eigen::Vector3f& view, float reach, Samples& samples) {
  const TriangleMesh& mesh = input.low;
  const Eigen::Vector3f position = position_at(mesh, place), normal = normal_at(mesh, place);
  const float offset = 1e-4f * reach;
  if (low.first_hit(position + offset * normal, view, 0, std::numeric_limits<float>::infinity()).found()) return false;
  const SurfacePoint stood = high.closest_facing_point(position, normal, reach);
  const SurfacePoint seen = high.first_hit(position + reach * view, -view, 0, 2 * reach);
  if (!stood.found() || !seen.found()) return false;
  if (normal_at(input.high, seen).dot(view) <= 0) return false;
  samples.seen_positions.push_back(position_at(input.high, seen));
  samples.seen_normals.push_back(normal_at(input.high, seen));
  samples.stood_positions.push_back(position_at(input.high, stood));
  samples.stood_normals.push_back(normal_at(input.high, stood));
  samples.lookups.push_back(lookup_at(interpolate(mesh, mesh.uvs, place), input.detail));
  return true;
}

Samples make_samples(const SplitInput& input) {
  const TriangleMesh& mesh = input.low;
  std::vector<double> areas;
  for (const Triangle& t : mesh.triangles) areas.push_back(area_normal(mesh, t).norm());
  std::mt19937 random(static_cast<std::mt19937::result_type>(input.seed));
  std::discrete_distribution<std::uint32_t> triangle(areas.begin(), areas.end());
  std::uniform_real_distribution<float> number(0, 1);
  const RayScene high(input.high), low(mesh);
  const float reach = 0.05f * bounding_box(input.high).sides().norm();
  Samples samples;
  // Some views are blocked, by a third at most on scans; give up after many.
  for (std::size_t tries = 0; samples.lookups.size() < sample_count && tries < 8 * sample_count; ++tries) {
    const float root = std::sqrt(number(random)), share = number(random);
    const SurfacePoint place{triangle(random), root * (1 - share), root * share, 0};
    // By the cosine: every part of the surface is seen as large as it is.
    const float squared_sine = number(random), turn = number(random);
    add_sample(input, high, low, place, cosine_direction(normal_at(mesh, place), squared_sine, turn), reach, samples);
  }
  return samples;
}

/// Transfer vectors of receivers, one after another.
struct Vectors {
  std::size_t length = 0;
  std::vector<float> values;

  std::span<const float> of(std::size_t k) const { return {values.data() + k * length, length}; }
};

Vectors in_rows(const TransferVectors& transfer) {
  Vectors rows{static_cast<std::size_t>(transfer.coefficients), {}};
  rows.values.resize(transfer.receivers * rows.length);
  for (std::size_t i = 0; i < rows.length; ++i) {
    const std::span<const float> plane = transfer.plane(static_cast<int>(i));
    for (std::size_t r = 0; r < transfer.receivers; ++r) rows.values[r * rows.length + i] = plane[r];
  }
  return rows;
}

/// Looks up vectors of texels at all samples. `of_texel` are vectors of `texels`, which are sorted.
Vectors looked_up(const Samples& samples, const std::vector<std::uint32_t>& texels, const Vectors& of_texel) {
  Vectors result{of_texel.length, std::vector<float>(samples.lookups.size() * of_texel.length)};
  for (std::size_t s = 0; s < samples.lookups.size(); ++s)
    for (int k = 0; k < 4; ++k) {
      const auto at = std::ranges::lower_bound(texels, samples.lookups[s].texels[k]) - texels.begin();
      const std::span<const float> vector = of_texel.of(static_cast<std::size_t>(at));
      for (std::size_t i = 0; i < of_texel.length; ++i)
        result.values[s * of_texel.length + i] += samples.lookups[s].weights[k] * vector[i];
    }
  return result;
}

/// Sums that E is made of, by the prior over light.
class WeightedSums {
 public:
  explicit WeightedSums(int bands) : prior_(lighting_prior(bands)) {}

  /// Returns d' S d of two vectors, over the first `length` coefficients.
  double difference(std::span<const float> a, std::span<const float> b, std::size_t length) const {
    double sum = 0;
    for (std::size_t i = 0; i < length; ++i) {
      const double d = double{a[i]} - double{b[i]};
      sum += weight(i) * d * d;
    }
    return sum;
  }

  /// Returns t' S t of coefficients `from` to `to`.
  double square(std::span<const float> t, std::size_t from, std::size_t to) const {
    double sum = 0;
    for (std::size_t i = from; i < to; ++i) sum += weight(i) * double{t[i]} * double{t[i]};
    return sum;
  }

 private:
  double weight(std::size_t i) const { return prior_[static_cast<std::size_t>(band_of(static_cast<int>(i)))]; }

  std::vector<double> prior_;
};

std::vector<std::uint32_t> texels_of(const Samples& samples) {
  std::vector<std::uint32_t> texels;
  for (const Lookup& lookup : samples.lookups) texels.insert(texels.end(), lookup.texels.begin(), lookup.texels.end());
  std::ranges::sort(texels);
  texels.erase(std::unique(texels.begin(), texels.end()), texels.end());
  return texels;
}

Vectors stored_vectors(const PrtAsset& asset, const std::vector<std::uint32_t>& texels) {
  Vectors vectors{asset.vector_length(), {}};
  vectors.values.resize(texels.size() * vectors.length);
  decode_transfer(asset, texels, vectors.values);
  return vectors;
}

/// Rounds vectors as the planes of an asset store them.
Vectors rounded_to(const PrtAsset& asset, Vectors vectors) {
  for (std::size_t k = 0; k < vectors.values.size(); ++k) {
    const PlaneRange& range = asset.planes[k % vectors.length].range;
    const double step = range.step(asset.bits);
    const double value = std::clamp<double>(vectors.values[k], range.lowest, range.highest);
    vectors.values[k] =
        static_cast<float>(step > 0 ? range.lowest + step * std::round((value - range.lowest) / step) : range.lowest);
  }
  return vectors;
}

}  // namespace

double ErrorSplit::root_sum() const {
  double sum = 0;
  for (const ErrorCause& cause : causes) sum += cause.error * cause.error;
  return std::sqrt(sum);
}

ErrorSplit error_causes(const SplitInput& input, const ProgressFunction& progress) {
  const Samples samples = make_samples(input);
  const std::vector<std::uint32_t> texels = texels_of(samples);
  ErrorSplit split;
  split.samples = samples.lookups.size();
  split.directions = std::clamp(4 * static_cast<int>(input.bake_directions.size()), fewest_reference_directions,
                                most_reference_directions);
  split.bands = std::max(fewest_reference_bands, 2 * input.asset.bands);
  // Step 1: compute what stands at each station of the way from the viewer's surface to the stored planes.
  const RayScene scene(input.scene.mesh);
  const float ray_offset = rounding_offset(input.scene.mesh.positions);
  const auto reference = sample_directions(Sampling::fibonacci, split.directions, input.seed + 1);
  std::vector<Eigen::Vector3f> positions, normals;
  for (const std::uint32_t texel : texels) {
    const int i = static_cast<int>(texel) % input.detail.width, j = static_cast<int>(texel) / input.detail.width;
    const std::span<const float> p = input.detail.position.pixel(i, j), n = input.detail.normal_object.pixel(i, j);
    positions.emplace_back(p[0], p[1], p[2]);
    normals.emplace_back(n[0], n[1], n[2]);
  }
  const auto transfer = [&](const std::vector<Eigen::Vector3f>& at, const std::vector<Eigen::Vector3f>& normals_there,
                            std::span<const Eigen::Vector3f> directions, int bands) {
    return in_rows(transfer_by_rays(scene, Receivers{at, normals_there}, directions, bands, ray_offset));
  };
  const int bands = input.asset.bands;
  const Vectors seen = transfer(samples.seen_positions, samples.seen_normals, reference, split.bands);
  progress(0.3);
  const Vectors stood = transfer(samples.stood_positions, samples.stood_normals, reference, bands);
  progress(0.4);
  const Vectors at_texels = looked_up(samples, texels, transfer(positions, normals, reference, bands));
  progress(0.8);
  const Vectors by_bake = transfer(positions, normals, input.bake_directions, bands);
  progress(0.95);
  const Vectors with_directions = looked_up(samples, texels, by_bake);
  const Vectors with_bits = looked_up(samples, texels, rounded_to(input.asset, by_bake));
  const Vectors stored = looked_up(samples, texels, stored_vectors(input.asset, texels));
  const Vectors compressed =
      input.compressed != nullptr ? looked_up(samples, texels, stored_vectors(*input.compressed, texels)) : stored;

  // Step 2: add up the differences from station to station.
  const WeightedSums sums(split.bands);
  const auto length = static_cast<std::size_t>(coefficient_count(bands));
  double norm = 0, whole = 0, geometry = 0, filtering = 0, directions = 0, bits = 0, visibility = 0, seams = 0,
         compression = 0, beyond = 0;
  for (std::size_t s = 0; s < samples.lookups.size(); ++s) {
    norm += sums.square(seen.of(s), 0, length);
    const double tail = sums.square(seen.of(s), length, seen.length);
    beyond += tail;
    whole += sums.difference(compressed.of(s), seen.of(s), length) + tail;
    geometry += sums.difference(stood.of(s), seen.of(s), length);
    compression += sums.difference(compressed.of(s), stored.of(s), length);
    if (samples.lookups[s].at_border) {
      // Gutters are filled and both sides made equal, which mends part of what the texels there cost.
      seams += sums.difference(stored.of(s), stood.of(s), length);
      continue;
    }
    filtering += sums.difference(at_texels.of(s), stood.of(s), length);
    directions += sums.difference(with_directions.of(s), at_texels.of(s), length);
    bits += sums.difference(with_bits.of(s), with_directions.of(s), length);
    visibility += sums.difference(stored.of(s), with_bits.of(s), length);
  }
  // Without a sample, or without any light, the error is not a number, which keeps no budget.
  const auto error = [&](double sum) { return std::sqrt(sum / norm); };
  split.total = error(whole);
  split.causes = {{"geometry", error(geometry)}, {"texels", error(filtering)},
                  {"bands", error(beyond)},      {"directions", error(directions)},
                  {"bits", error(bits)},         {"visibility", error(visibility)},
                  {"seams", error(seams)}};
  if (input.compressed != nullptr) split.causes.push_back({"compression", error(compression)});
  return split;
}

Json to_json(const ErrorSplit& split) {
  Json causes = Json::object();
  for (const ErrorCause& cause : split.causes) causes[cause.name] = cause.error;
  return {{"total", split.total},
          {"causes", causes},
          {"root_sum_of_causes", split.root_sum()},
          {"samples", split.samples},
          {"reference_directions", split.directions},
          {"reference_bands", split.bands}};
}

}  // namespace kiln
