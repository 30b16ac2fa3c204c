// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/error_causes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>

#include "base/json.h"
#include "raycast/ray_scene.h"
#include "raycast/ray_transfer.h"
#include "report/bounce_paths.h"
#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/light_prior.h"
#include "sh/ray_offset.h"

namespace kiln {

namespace {

constexpr int fewest_reference_directions = 4096;
constexpr int most_reference_directions = 65536;
constexpr int fewest_reference_bands = 16;
constexpr int path_directions = 512;  // of each of two sets, where light bounces

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

/// Looks up vectors of texels at all points. `of_texel` are vectors of `texels`, which are sorted.
Vectors looked_up(const ErrorSamples& samples, const std::vector<std::uint32_t>& texels, const Vectors& of_texel) {
  Vectors result{of_texel.length, std::vector<float>(samples.points() * of_texel.length)};
  for (std::size_t s = 0; s < samples.points(); ++s)
    for (int k = 0; k < 4; ++k) {
      const auto at = std::ranges::lower_bound(texels, samples.lookups[s].texels[k]) - texels.begin();
      const std::span<const float> vector = of_texel.of(static_cast<std::size_t>(at));
      for (std::size_t i = 0; i < of_texel.length; ++i)
        result.values[s * of_texel.length + i] += samples.lookups[s].weights[k] * vector[i];
    }
  return result;
}

/// Returns the first coefficients of each vector, once for every channel.
Vectors in_channels(const Vectors& vectors, int coefficients, int channels) {
  Vectors result{static_cast<std::size_t>(coefficients) * static_cast<std::size_t>(channels), {}};
  for (std::size_t k = 0; k * vectors.length < vectors.values.size(); ++k)
    for (int c = 0; c < channels; ++c) {
      const std::span<const float> first = vectors.of(k).first(static_cast<std::size_t>(coefficients));
      result.values.insert(result.values.end(), first.begin(), first.end());
    }
  return result;
}

Vectors sum_of(Vectors a, const Vectors& b) {
  std::ranges::transform(a.values, b.values, a.values.begin(), std::plus<>());
  return a;
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
    const double steps = std::round((double{vectors.values[k]} - range.lowest) / step);
    vectors.values[k] = static_cast<float>(step > 0 ? range.lowest + step * steps : range.lowest);
  }
  return vectors;
}

/// Two estimates of the same vectors, alike where there is no noise in them.
struct Station {
  Vectors first, second;

  explicit Station(const Vectors& both) : first(both), second(both) {}
  Station(Vectors one, Vectors other) : first(std::move(one)), second(std::move(other)) {}

  Station operator+(const Station& other) const { return {sum_of(first, other.first), sum_of(second, other.second)}; }
};

/// Points that count for a step.
enum class StepPoints { all, inside_charts, at_borders };

/// One thing that changes on the way from what is seen to what is stored.
struct Step {
  std::string cause;
  const Station& from;
  const Station& to;
  StepPoints points = StepPoints::all;
};

/// Squares, weighted by the prior over light.
struct Squares {
  BandSquares by_band;           ///< sums over pixels
  std::vector<double> by_pixel;  ///< sums over bands

  double total() const { return std::accumulate(by_band.begin(), by_band.end(), 0.0); }
};

/// Returns the half-width of the 95 % confidence interval of sqrt(a / b + more), for sums over pixels as they happened
/// to fall ([Cochran 1977], section 6.4).
double uncertainty_of_root(const Squares& a, const Squares& b, double more) {
  const double norm = b.total(), ratio = a.total() / norm;
  double sum = 0;
  for (std::size_t k = 0; k < a.by_pixel.size(); ++k) {
    const double residual = a.by_pixel[k] - ratio * b.by_pixel[k];
    sum += residual * residual;
  }
  return 1.96 * std::sqrt(sum) / norm / (2 * std::sqrt(ratio + more));
}

/// Sums squares over pixels.
class PixelSums {
 public:
  PixelSums(const ErrorSamples& samples, std::vector<double> prior) : samples_(samples), prior_(std::move(prior)) {}

  /// Returns d' S d by band, in the sum over pixels; d is a step's difference in the mean over a pixel's points, and
  /// the product is of its two estimates. Vectors hold `bands` bands of each channel.
  Squares of_step(const Step& step, int bands) const {
    return sum(bands, step.points, step.from.first.length, [&](std::size_t point, auto& first, auto& second) {
      first += as_array(step.to.first, point) - as_array(step.from.first, point);
      second += as_array(step.to.second, point) - as_array(step.from.second, point);
    });
  }

  /// Returns t' S t by band, likewise.
  Squares of_vectors(const Station& vectors, int bands) const {
    return sum(bands, StepPoints::all, vectors.first.length, [&](std::size_t point, auto& first, auto& second) {
      first += as_array(vectors.first, point);
      second += as_array(vectors.second, point);
    });
  }

 private:
  static Eigen::ArrayXd as_array(const Vectors& vectors, std::size_t point) {
    const std::span<const float> values = vectors.of(point);
    return Eigen::Map<const Eigen::ArrayXf>(values.data(), static_cast<Eigen::Index>(values.size())).cast<double>();
  }

  bool counts(std::size_t point, StepPoints points) const {
    return points == StepPoints::all || samples_.lookups[point].at_border == (points == StepPoints::at_borders);
  }

  template <class AddPoint>
  Squares sum(int bands, StepPoints points, std::size_t length, const AddPoint& add_point) const {
    Squares squares{BandSquares(static_cast<std::size_t>(bands)), {}};
    const auto coefficients = static_cast<std::size_t>(coefficient_count(bands));
    Eigen::ArrayXd first(length), second(length);
    std::size_t begin = 0;
    for (std::size_t pixel = 0; pixel < samples_.pixels(); ++pixel) {
      const std::size_t end = samples_.pixel_ends[pixel];
      first.setZero();
      second.setZero();
      for (std::size_t point = begin; point < end; ++point)
        if (counts(point, points)) add_point(point, first, second);
      const double share = 1 / static_cast<double>(end - begin);
      const double weight = samples_.pixel_weights[pixel] * share * share;
      double of_pixel = 0;
      for (std::size_t i = 0; i < length; ++i) {
        const auto band = static_cast<std::size_t>(band_of(static_cast<int>(i % coefficients)));
        const auto at = static_cast<Eigen::Index>(i);
        const double square = weight * prior_[band] * first[at] * second[at];
        squares.by_band[band] += square;
        of_pixel += square;
      }
      squares.by_pixel.push_back(of_pixel);
      begin = end;
    }
    return squares;
  }

  const ErrorSamples& samples_;
  const std::vector<double> prior_;
};

/// Computes transfer at points of the scene, by rays and, of light that bounces, by paths.
class Transport {
 public:
  Transport(const SplitInput& input, int directions)
      : input_(input),
        scene_(input.scene.mesh),
        offset_(rounding_offset(input.scene.mesh.positions)),
        directions_(sample_directions(Sampling::fibonacci, directions, input.sampling.seed + 1)) {}

  Vectors direct(const Receivers& receivers, int bands) const { return direct(receivers, bands, directions_); }

  Vectors direct(const Receivers& receivers, int bands, std::span<const Eigen::Vector3f> directions) const {
    return in_rows(transfer_by_rays(scene_, receivers, directions, bands, offset_));
  }

  /// Returns the transfer of bounced light alone, in the asset's bands and channels; zeros where light does not bounce.
  Station bounced(const Receivers& receivers) const { return {by_paths(receivers, 0), by_paths(receivers, 1)}; }

 private:
  /// Returns that by one of two sets of paths.
  Vectors by_paths(const Receivers& receivers, int set) const {
    Vectors result{input_.asset.vector_length(), {}};
    if (input_.bounces == 0) {
      result.values.assign(receivers.size() * result.length, 0.f);
      return result;
    }
    const int coefficients = coefficient_count(input_.asset.bands);
    std::vector<TransferVectors> colors(3, TransferVectors(receivers.size(), coefficients));
    const std::uint64_t seed = input_.sampling.seed + 2 + static_cast<std::uint64_t>(set);
    const BouncePaths paths(scene_, input_.scene, input_.bounces, offset_);
    paths.add(receivers, sample_directions(Sampling::fibonacci, path_directions, seed), seed << 32, colors);
    result.values.reserve(receivers.size() * result.length);
    if (input_.asset.channels == 1) {
      // A single channel stands for all colours.
      for (std::size_t k = 0; k < colors[0].values.size(); ++k)
        colors[0].values[k] = (colors[0].values[k] + colors[1].values[k] + colors[2].values[k]) / 3;
    }
    for (std::size_t r = 0; r < receivers.size(); ++r)
      for (std::size_t c = 0; c < static_cast<std::size_t>(input_.asset.channels); ++c)
        for (int i = 0; i < coefficients; ++i) result.values.push_back(colors[c].plane(i)[r]);
    return result;
  }

  const SplitInput& input_;
  const RayScene scene_;
  const float offset_;
  const std::vector<Eigen::Vector3f> directions_;
};

/// Points that texels stand for.
struct TexelPoints {
  std::vector<Eigen::Vector3f> positions, normals;

  TexelPoints(const std::vector<std::uint32_t>& texels, const DetailMaps& detail) {
    for (const std::uint32_t texel : texels) {
      const int i = static_cast<int>(texel) % detail.width, j = static_cast<int>(texel) / detail.width;
      const std::span<const float> p = detail.position.pixel(i, j), n = detail.normal_object.pixel(i, j);
      positions.emplace_back(p[0], p[1], p[2]);
      normals.emplace_back(n[0], n[1], n[2]);
    }
  }
};

ErrorSampling sampling_of(const SplitInput& input) {
  ErrorSampling sampling = input.sampling;
  if (input.bounces > 0 || sampling.pixel_size > 0) sampling.pixels = std::max<std::size_t>(1, sampling.pixels / 2);
  return sampling;
}

}  // namespace

double ErrorSplit::root_sum() const {
  double sum = 0;
  for (const ErrorCause& cause : causes) sum += cause.error * cause.error;
  return std::sqrt(sum);
}

int reference_bands(int asset_bands) { return std::max(fewest_reference_bands, 2 * asset_bands); }

ErrorSplit error_causes(const SplitInput& input, const ProgressFunction& progress) {
  const ErrorSamples samples = make_error_samples(input.high, input.low, input.detail, sampling_of(input));
  const std::vector<std::uint32_t> texels = samples.texels();
  const TexelPoints points(texels, input.detail);
  const Receivers at_texels{points.positions, points.normals}, at_seen{samples.seen_positions, samples.seen_normals},
      at_stood{samples.stood_positions, samples.stood_normals};
  const int bands = input.asset.bands, channels = input.asset.channels, coefficients = coefficient_count(bands);
  ErrorSplit split;
  split.samples = samples.pixels();
  split.directions = std::clamp(4 * static_cast<int>(input.bake_directions.size()), fewest_reference_directions,
                                most_reference_directions);
  split.bands = reference_bands(bands);

  // Step 1: compute what stands at each station of the way from the viewer's surface to the stored planes.
  const Transport transport(input, split.directions);
  const auto in_all_channels = [&](const Vectors& direct) { return in_channels(direct, coefficients, channels); };
  const Vectors seen_in_all_bands = transport.direct(at_seen, split.bands);
  progress(0.3);
  const Station direct_seen(in_all_channels(seen_in_all_bands));
  const Station direct_stood(in_all_channels(transport.direct(at_stood, bands)));
  progress(0.6);
  const Station sampled(in_all_channels(transport.direct(at_stood, bands, input.bake_directions)));
  const Vectors by_bake = in_all_channels(transport.direct(at_texels, bands, input.bake_directions));
  progress(0.8);
  const Station filtered(looked_up(samples, texels, by_bake));
  const Station rounded(looked_up(samples, texels, rounded_to(input.asset, by_bake)));
  const Station stored(looked_up(samples, texels, stored_vectors(input.asset, texels)));
  const Station compressed(input.compressed != nullptr
                               ? looked_up(samples, texels, stored_vectors(*input.compressed, texels))
                               : stored.first);
  const Station bounced_seen = transport.bounced(at_seen);
  const Station seen = direct_seen + bounced_seen;
  progress(0.9);
  // Bounced light is smooth: what arrives at the point seen arrives at the one near it, too.
  const Station sampled_with_paths = sampled + bounced_seen;
  const Station bounced_at_texels = transport.bounced(at_texels);
  const Station with_paths = rounded + Station(looked_up(samples, texels, bounced_at_texels.first),
                                               looked_up(samples, texels, bounced_at_texels.second));
  progress(0.97);

  // Step 2: add up the differences from station to station.
  const PixelSums sums(samples, input.prior.empty() ? lighting_prior(split.bands) : input.prior);
  const auto inside = StepPoints::inside_charts;
  const Step steps[] = {{"geometry", direct_seen, direct_stood},
                        {"directions", direct_stood, sampled},
                        {"texels", sampled, filtered, inside},
                        {"bits", filtered, rounded, inside},
                        {input.bounces > 0 ? "bounces" : "visibility", with_paths, stored, inside},
                        // Gutters are filled and both sides made equal, which mends part of what the texels there cost.
                        {"seams", sampled_with_paths, stored, StepPoints::at_borders},
                        {"compression", stored, compressed}};
  const Squares cut = sums.of_vectors(seen, bands);
  Squares all =
      sums.of_vectors(Station(in_channels(seen_in_all_bands, coefficient_count(split.bands), channels)), split.bands);
  std::ranges::copy(cut.by_band, all.by_band.begin());
  const double norm = cut.total(), tail = (all.total() - norm) / norm;
  // Without a sample, or without any light, the error is not a number, which keeps no budget.
  const auto error = [](double square) { return std::sqrt(square < 0 ? 0 : square); };
  const auto relative = [&](BandSquares squares) {
    for (double& square : squares) square /= norm;
    return squares;
  };
  const Squares whole = sums.of_step({"total", seen, compressed}, bands);
  split.seen = relative(all.by_band);
  split.total = error(whole.total() / norm + tail);
  split.squares = relative(whole.by_band);
  split.uncertainty = uncertainty_of_root(whole, cut, tail);
  for (const Step& step : steps) {
    if (step.cause == "compression" && input.compressed == nullptr) continue;
    const Squares squares = sums.of_step(step, bands);
    split.causes.push_back({step.cause, error(squares.total() / norm), relative(squares.by_band)});
  }
  split.causes.push_back({"bands", error(tail), {}});
  return split;
}

Json to_json(const ErrorSplit& split) {
  Json causes = Json::object(), squares = {{"seen", split.seen}, {"total", split.squares}};
  for (const ErrorCause& cause : split.causes) {
    causes[cause.name] = cause.error;
    if (!cause.squares.empty()) squares[cause.name] = cause.squares;
  }
  return {{"total", split.total},
          {"uncertainty", split.uncertainty},
          {"causes", causes},
          {"root_sum_of_causes", split.root_sum()},
          {"squares_by_band", squares},
          {"samples", split.samples},
          {"reference_directions", split.directions},
          {"reference_bands", split.bands}};
}

}  // namespace kiln
