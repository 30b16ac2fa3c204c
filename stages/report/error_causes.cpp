// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/error_causes.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numeric>
#include <optional>

#include "base/json.h"
#include "base/parallel.h"
#include "image/srgb.h"
#include "raycast/ray_scene.h"
#include "report/path_albedo.h"
#include "report/split_transport.h"
#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/light_prior.h"

namespace kiln {

namespace {

constexpr int fewest_reference_directions = 4096;
constexpr int most_reference_directions = 65536;
constexpr int fewest_reference_bands = 16;
constexpr int scatter_lines = 512;  // about a point, of each of two sets: their noise counts more than points do

/// Points with their normals.
struct PointList {
  std::vector<Eigen::Vector3f> positions, normals;

  Receivers receivers() const { return {positions, normals}; }
};

/// Returns points of texels.
PointList points_of(const DetailMaps& detail, const std::vector<std::uint32_t>& texels) {
  PointList points;
  for (const std::uint32_t texel : texels) {
    const int i = static_cast<int>(texel) % detail.width, j = static_cast<int>(texel) / detail.width;
    const std::span<const float> p = detail.position.pixel(i, j), n = detail.normal_object.pixel(i, j);
    points.positions.emplace_back(p[0], p[1], p[2]);
    points.normals.emplace_back(n[0], n[1], n[2]);
  }
  return points;
}

/// Returns the points of the high mesh that vertices of the low one stand for.
PointList points_of_vertices(const SplitInput& input, const std::vector<std::uint32_t>& vertices) {
  PointList points;
  const RayScene high(input.high);
  for (const std::uint32_t vertex : vertices) {
    // Normals of the file are those of the receivers.
    const Eigen::Vector3f &position = input.low.positions[vertex], &normal = input.low.normals[vertex];
    const SurfacePoint found = high.closest_facing_point(position, normal, std::numeric_limits<float>::infinity());
    points.positions.push_back(found.found() ? position_at(input.high, found) : position);
    points.normals.push_back(normal);
  }
  return points;
}

/// Returns the points of the high mesh that slots stand for.
PointList points_on_high(const SplitInput& input, const std::vector<std::uint32_t>& slots) {
  return input.detail != nullptr ? points_of(*input.detail, slots) : points_of_vertices(input, slots);
}

/// Returns the points of the bake's receivers, where those are on the low mesh.
PointList points_on_low(const SplitInput& input, const std::vector<std::uint32_t>& slots) {
  if (input.on_low == nullptr) return {};
  if (input.on_low->detail != nullptr) return points_of(*input.on_low->detail, slots);
  PointList points;
  for (const std::uint32_t vertex : slots) {
    points.positions.push_back(input.low.positions[vertex]);
    points.normals.push_back(input.low.normals[vertex]);
  }
  return points;
}

ErrorSampling sampling_of(const SplitInput& input) {
  ErrorSampling sampling = input.sampling;
  const std::size_t share = !input.scattering.empty() ? 4 : input.bounces > 0 || sampling.pixel_size > 0 ? 2 : 1;
  sampling.pixels = std::max<std::size_t>(1, sampling.pixels / share);
  return sampling;
}

/// Returns the transfer of free points with these normals.
TransferRows unshadowed_rows(const std::vector<Eigen::Vector3f>& normals, int bands) {
  const ShBasis basis(bands);
  TransferRows rows{static_cast<std::size_t>(basis.size()), {}};
  for (const Eigen::Vector3f& normal : normals) {
    const std::vector<float> values = unoccluded_transfer(basis, normal);
    rows.values.insert(rows.values.end(), values.begin(), values.end());
  }
  return rows;
}

using Colors = std::vector<PathShares>;

/// Returns what a reflectance that ships has at wavelengths: linear between its values, and constant beyond them.
PathShares shipped_shares(const PrtReflectance& reflectance, const std::vector<int>& wavelengths_nm) {
  PathShares shares(static_cast<Eigen::Index>(wavelengths_nm.size()));
  const double last = static_cast<double>(reflectance.values.size() - 1);
  for (std::size_t k = 0; k < wavelengths_nm.size(); ++k) {
    const double place =
        std::clamp(static_cast<double>(wavelengths_nm[k] - reflectance.first_nm) / reflectance.step_nm, 0.0, last);
    const auto before = static_cast<std::size_t>(std::min(place, std::max(0.0, last - 1)));
    const double share = place - static_cast<double>(before);
    const std::size_t after = std::min(before + 1, reflectance.values.size() - 1);
    shares[static_cast<Eigen::Index>(k)] =
        static_cast<float>((1 - share) * reflectance.values[before] + share * reflectance.values[after]);
  }
  return shares;
}

/// Returns the wavelengths that channels are of; none where they are colours.
std::vector<int> wavelengths_of(const PrtAsset& asset) {
  return asset.spectrum ? asset.spectrum->wavelengths_nm : std::vector<int>();
}

/// What albedo does to transfer: nothing, or what the high mesh's own and the asset's make of it.
class Paint {
 public:
  Paint(const SplitInput& input, const ErrorSamples& samples, const std::vector<std::uint32_t>& slots,
        const PointList& slot_points)
      : within_(input.albedo != nullptr && input.albedo_within),
        in_map_(input.albedo != nullptr && !within_ && input.asset.albedo.picture.width() > 0),
        is_spectral_(input.asset.spectrum.has_value()),
        baked_channels_(input.asset.channels),
        channels_(in_map_ ? std::max(3, input.asset.channels) : input.asset.channels) {
    if (!within_ && !in_map_) return;
    PathAlbedo albedo({*input.albedo}, wavelengths_of(input.asset));
    albedo.prepare_table();
    const auto color_at = [&](const SurfacePoint& point) {
      return albedo.lifted_at(0, point.triangle, point.u, point.v);
    };
    std::ranges::transform(samples.seen, std::back_inserter(seen_), color_at);
    std::ranges::transform(samples.stood, std::back_inserter(stood_), color_at);
    if (is_spectral_) {
      // Who draws wavelengths multiplies them by what the map reflects at the texels of the planes.
      std::vector<PathShares> measured;
      for (const PrtReflectance& reflectance : input.asset.albedo.reflectances)
        measured.push_back(shipped_shares(reflectance, input.asset.spectrum->wavelengths_nm));
      for (const std::uint32_t texel : slots) {
        const PrtReflectance* const of_texel = input.asset.albedo.measured(texel);
        shown_.push_back(of_texel == nullptr
                             ? albedo.of(input.asset.albedo.at(texel))
                             : measured[static_cast<std::size_t>(of_texel - input.asset.albedo.reflectances.data())]);
      }
      return;
    }
    if (in_map_) {
      for (const Eigen::Vector2f& uv : samples.uvs) shown_.push_back(color_in_map(input.asset.albedo.picture, uv));
      return;
    }
    slots_.resize(slots.size());
    const RayScene high(input.high);
    parallel_for(std::size_t{0}, slots.size(), 256, [&](std::size_t k) {
      slots_[k] = color_at(high.closest_point(slot_points.positions[k], std::numeric_limits<float>::infinity()));
    });
    baked_ = slots_;
    if (input.detail == nullptr || !input.map_albedo) return;
    const auto width = static_cast<std::uint32_t>(input.detail->width);
    std::ranges::transform(slots, baked_.begin(), [&](std::uint32_t texel) {
      return shares_of(input.detail->albedo_at(static_cast<int>(texel % width), static_cast<int>(texel / width)));
    });
  }

  bool within() const { return within_; }
  bool in_map() const { return in_map_; }
  int channels() const { return channels_; }  ///< of painted vectors

  /// Paints vectors of the asset's channels: as the high mesh's points have it, as the asset's map has it, or, only
  /// where the albedo is within, slots as the high mesh and as the bake have them.
  TransferRows seen(const TransferRows& vectors) const { return painted(vectors, seen_); }
  TransferRows stood(const TransferRows& vectors) const { return painted(vectors, stood_); }

  /// Looks up what an asset stores at the slots, times its map.
  TransferRows shown(const TransferRows& stored, const std::vector<Lookup>& lookups,
                     const std::vector<std::uint32_t>& slots) const {
    if (is_spectral_) return kiln::looked_up(lookups, slots, painted(stored, shown_));
    return painted(kiln::looked_up(lookups, slots, stored), shown_);
  }
  TransferRows slots(const TransferRows& vectors) const { return within_ ? painted(vectors, slots_) : vectors; }
  TransferRows baked(const TransferRows& vectors) const { return within_ ? painted(vectors, baked_) : vectors; }

  /// Paints what is looked up in the asset: by the high mesh, where its transfer is without albedo.
  TransferRows looked_up(const TransferRows& vectors) const { return in_map_ ? painted(vectors, stood_) : vectors; }

 private:
  TransferRows painted(const TransferRows& vectors, const Colors& colors) const {
    if (!within_ && !in_map_) return vectors;
    if (channels_ == baked_channels_) return times(vectors, colors, channels_);
    return times(in_channels(vectors, static_cast<int>(vectors.length), channels_), colors, channels_);
  }

  /// Looks up a picture of sRGB bytes bilinearly, as a GPU does.
  static PathShares color_in_map(const Image<std::uint8_t>& picture, const Eigen::Vector2f& uv) {
    const float x = uv.x() * static_cast<float>(picture.width()) - 0.5f,
                y = uv.y() * static_cast<float>(picture.height()) - 0.5f;
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    const float s = x - static_cast<float>(i), t = y - static_cast<float>(j);
    Eigen::Vector3f color = Eigen::Vector3f::Zero();
    for (int k = 0; k < 4; ++k) {
      const auto texel =
          picture.pixel(std::clamp(i + k % 2, 0, picture.width() - 1), std::clamp(j + k / 2, 0, picture.height() - 1));
      const float weight = (k % 2 == 0 ? 1 - s : s) * (k / 2 == 0 ? 1 - t : t);
      for (int c = 0; c < 3; ++c)
        color[c] += weight * linear_from_srgb(static_cast<float>(texel[static_cast<std::size_t>(c)]) / 255);
    }
    return shares_of(color);
  }

  const bool within_, in_map_, is_spectral_;
  const int baked_channels_, channels_;
  Colors seen_, stood_, shown_, slots_, baked_;
};

/// Way from what a viewer should see to what the asset shows.
class SplitWay {
 public:
  SplitWay(const SplitInput& input, const ProgressFunction& progress)
      : input_(input),
        progress_(progress),
        samples_(make_error_samples(input.high, input.low, input.detail, sampling_of(input))),
        slots_(slots_of(samples_.lookups)),
        high_points_(points_on_high(input, slots_)),
        low_points_(points_on_low(input, slots_)),
        paint_(input, samples_, slots_, high_points_),
        light_{.bounces = input.bounces,
               .scattering = input.scattering,
               .mm_per_unit = input.mm_per_unit,
               // A pixel's points have noise of their own.
               .lines = input.sampling.pixel_size > 0 ? scatter_lines / 4 : scatter_lines,
               .channels = input.asset.channels,
               .wavelengths_nm = wavelengths_of(input.asset),
               .seed = input.sampling.seed},
        transport_(input.scene, input.high, light_) {
    if (input.on_low != nullptr) low_transport_.emplace(input.on_low->shadows, input.low, light_);
    split_.samples = samples_.pixels();
    split_.directions = std::clamp(4 * static_cast<int>(input.bake_directions.size()), fewest_reference_directions,
                                   most_reference_directions);
    if (!input.scattering.empty()) split_.directions = light_.lines;
    split_.bands = reference_bands(input.asset.bands);
  }

  ErrorSplit measure() {
    // Step 1: compute what stands at each station, from the viewer's surface to the stored planes.
    if (input_.scattering.empty())
      add_surface_steps();
    else
      add_scattered_steps();
    const Station& stored = *stored_;
    const Station& compressed =
        input_.compressed == nullptr ? stored : add(Station(paint_.looked_up(looked_up_in(*input_.compressed))));
    steps_.push_back({"compression", stored, compressed});
    const Station* shown = &compressed;
    if (paint_.in_map()) {
      const PrtAsset& drawn = input_.compressed == nullptr ? input_.asset : *input_.compressed;
      shown = &add(Station(paint_.shown(stored_rows(drawn, slots_), samples_.lookups, slots_)));
      steps_.push_back({"albedo", compressed, *shown});
    }
    progress_(0.97);

    // Step 2: add up the differences from station to station.
    const PixelSums sums(samples_, input_.prior.empty() ? lighting_prior(split_.bands) : input_.prior);
    const int bands = input_.asset.bands;
    const WeightedSquares cut = sums.of_vectors(*seen_, bands);
    WeightedSquares all = sums.of_vectors(*seen_in_all_bands_, split_.bands);
    std::ranges::copy(cut.by_band, all.by_band.begin());
    const double norm = cut.total(), tail = (all.total() - norm) / norm;
    // Without a sample, or without any light, the error is not a number, which keeps no budget.
    const auto error = [](double square) { return std::sqrt(square < 0 ? 0 : square); };
    const auto relative = [&](BandSquares squares) {
      for (double& square : squares) square /= norm;
      return squares;
    };
    const WeightedSquares whole = sums.of_step({"total", *seen_, *shown}, bands);
    split_.seen = relative(all.by_band);
    split_.total = error(whole.total() / norm + tail);
    split_.squares = relative(whole.by_band);
    split_.uncertainty = uncertainty_of_root(whole, cut, tail);
    const auto cause_of = [&](const CauseStep& step, const BandSquares& of_step) {
      return ErrorCause{step.cause, error(std::accumulate(of_step.begin(), of_step.end(), 0.0)), of_step};
    };
    const auto measured = [&](const CauseStep& step) {
      return cause_of(step, relative(sums.of_step(step, bands).by_band));
    };
    if (at_vertices_) split_.at_vertices = measured(*at_vertices_);
    if (unshadowed_) split_.unshadowed = measured(*unshadowed_);
    for (const CauseStep& step : steps_) {
      if (step.cause == "compression" && input_.compressed == nullptr) continue;
      BandSquares squares = relative(sums.of_step(step, bands).by_band);
      if (!step.without.empty()) {
        const auto part = std::ranges::find(split_.causes, step.without, &ErrorCause::name);
        std::ranges::transform(squares, part->squares, squares.begin(), std::minus<>());
      }
      split_.causes.push_back(cause_of(step, squares));
    }
    if (std::ranges::find(split_.causes, "albedo", &ErrorCause::name) == split_.causes.end())
      split_.causes.push_back({"albedo", 0, BandSquares(static_cast<std::size_t>(bands))});
    split_.causes.push_back({"bands", error(tail), {}});
    return std::move(split_);
  }

 private:
  const Station& add(Station station) { return stations_.emplace_back(std::move(station)); }

  Receivers at_seen() const { return {samples_.seen_positions, samples_.seen_normals}; }
  Receivers at_stood() const { return {samples_.stood_positions, samples_.stood_normals}; }

  TransferRows looked_up_in(const PrtAsset& asset) const {
    return looked_up(samples_.lookups, slots_, stored_rows(asset, slots_));
  }

  std::string lookups_cause() const { return input_.detail != nullptr ? "texels" : "vertices"; }

  /// Adds the steps of light that leaves the surface where it arrives.
  void add_surface_steps() {
    const int bands = input_.asset.bands, coefficients = coefficient_count(bands), channels = input_.asset.channels;
    const std::vector<Eigen::Vector3f> directions =
        sample_directions(Sampling::fibonacci, split_.directions, input_.sampling.seed + 1);
    const auto in_all_channels = [&](const TransferRows& direct) {
      return in_channels(direct, coefficients, channels);
    };
    const auto seen = [&](const TransferRows& vectors) { return paint_.seen(vectors); };
    const auto stood = [&](const TransferRows& vectors) { return paint_.stood(vectors); };

    const TransferRows in_all_bands = transport_.direct(at_seen(), split_.bands, directions);
    seen_in_all_bands_ = &add(Station(seen(in_channels(in_all_bands, coefficient_count(split_.bands), channels))));
    const Station& direct_seen = add(Station(seen(in_all_channels(in_all_bands))));
    progress_(0.3);
    const Station& direct_stood =
        add(Station(stood(in_all_channels(transport_.direct(at_stood(), bands, directions)))));
    steps_.push_back({"geometry", direct_seen, direct_stood});
    const Station bounced = transport_.bounced(at_seen(), bands);
    seen_ = &add(direct_seen + bounced.through(seen));
    progress_(0.6);

    const bool casts_shadows = !input_.bake_directions.empty();
    const auto by_bake = [&](const SplitTransport& transport, const Receivers& receivers) {
      return in_all_channels(transport.direct(receivers, bands, casts_shadows ? input_.bake_directions : directions));
    };
    const Station& sampled = add(Station(stood(by_bake(transport_, at_stood()))));
    steps_.push_back({"directions", direct_stood, sampled});
    if (input_.try_others && input_.detail != nullptr && input_.albedo == nullptr) {
      const std::vector<std::uint32_t> vertices = slots_of(samples_.vertex_lookups);
      const PointList points = points_of_vertices(input_, vertices);
      const Station& at_vertices =
          add(Station(looked_up(samples_.vertex_lookups, vertices, by_bake(transport_, points.receivers()))));
      at_vertices_.emplace(CauseStep{"vertices", sampled, at_vertices});
    }
    if (input_.try_others) {
      const Station& free = add(Station(stood(in_all_channels(unshadowed_rows(samples_.stood_normals, bands)))));
      unshadowed_.emplace(CauseStep{"shadows", direct_stood, free});
    }
    TransferRows at_slots = by_bake(transport_, high_points_.receivers());
    progress_(0.8);
    const auto of_slots = [&](const TransferRows& vectors) {
      return paint_.looked_up(looked_up(samples_.lookups, slots_, vectors));
    };
    const auto bounced_at = [&](const SplitTransport& transport, const Receivers& receivers) {
      return transport.bounced(receivers, bands);
    };
    const auto inside = StepPoints::inside_charts;
    const Station* filtered = &add(Station(of_slots(paint_.slots(at_slots))));
    steps_.push_back({lookups_cause(), sampled, *filtered, inside});
    const auto in_slots_color = [&](const TransferRows& vectors) { return of_slots(paint_.slots(vectors)); };
    Station bounced_at_slots = bounced_at(transport_, high_points_.receivers());
    if (low_transport_) {
      const Station& on_high = add(*filtered + bounced_at_slots.through(in_slots_color));
      at_slots = by_bake(*low_transport_, low_points_.receivers());
      bounced_at_slots = bounced_at(*low_transport_, low_points_.receivers());
      filtered = &add(Station(of_slots(paint_.slots(at_slots))));
      steps_.push_back({"receivers", on_high, add(*filtered + bounced_at_slots.through(in_slots_color)), inside});
    }
    if (!casts_shadows) {
      const PointList& points = low_transport_ ? low_points_ : high_points_;
      at_slots = in_all_channels(unshadowed_rows(points.normals, bands));
      const Station& free = add(Station(of_slots(paint_.slots(at_slots))));
      steps_.push_back({"shadows", *filtered, free, inside});
      filtered = &free;
    }
    if (paint_.within()) {
      const Station& colored = add(Station(of_slots(paint_.baked(at_slots))));
      steps_.push_back({"albedo", *filtered, colored, inside});
      filtered = &colored;
    }
    const Station& rounded = add(Station(of_slots(rounded_to(input_.asset, paint_.baked(at_slots)))));
    steps_.push_back({"bits", *filtered, rounded, inside});
    stored_ = &add(Station(paint_.looked_up(looked_up_in(input_.asset))));
    const Station& with_paths = add(rounded + bounced_at_slots.through([&](const TransferRows& vectors) {
      return of_slots(paint_.baked(vectors));
    }));
    steps_.push_back({input_.bounces > 0 ? "bounces" : "visibility", with_paths, *stored_, inside});
    // Bounced light is smooth: what arrives at the point seen arrives at the one near it, too.
    const Station& sampled_with_paths = add(sampled + bounced.through(stood));
    // Gutters are filled and both sides made equal, which mends part of what the texels there cost.
    steps_.push_back({"seams", sampled_with_paths, *stored_, StepPoints::at_borders});
    progress_(0.9);
  }

  /// Lists the points of the slots that each point of the samples looks up, four for each.
  PointList of_each_point(const PointList& of_slots) const {
    PointList points;
    for (const Lookup& lookup : samples_.lookups)
      for (const std::uint32_t slot : lookup.slots) {
        const auto at = static_cast<std::size_t>(std::ranges::lower_bound(slots_, slot) - slots_.begin());
        points.positions.push_back(of_slots.positions[at]);
        points.normals.push_back(of_slots.normals[at]);
      }
    return points;
  }

  /// Adds the steps of light that scatters beneath the surface.
  void add_scattered_steps() {
    const int bands = input_.asset.bands, coefficients = coefficient_count(bands), channels = input_.asset.channels;
    std::vector<std::uint64_t> numbers(samples_.points()), of_points;
    std::iota(numbers.begin(), numbers.end(), 0);
    for (std::size_t point = 0; point < samples_.points(); ++point) of_points.insert(of_points.end(), 4, point);

    seen_in_all_bands_ = &add(transport_.beneath(at_seen(), split_.bands, numbers));
    seen_ = &add(seen_in_all_bands_->through(
        [&](const TransferRows& vectors) { return cut_to(vectors, coefficients, channels); }));
    progress_(0.25);
    const Station& stood = add(transport_.beneath(at_stood(), bands, numbers));
    steps_.push_back({"geometry", *seen_, stood});
    progress_(0.4);
    const auto inside = StepPoints::inside_charts;
    const auto at_points = [&](const TransferRows& vectors) { return looked_up(samples_.lookups, vectors); };
    Station of_slots = transport_.beneath(of_each_point(high_points_).receivers(), bands, of_points);
    const Station* filtered = &add(of_slots.through(at_points));
    steps_.push_back({lookups_cause(), stood, *filtered, inside});
    if (low_transport_) {
      of_slots = low_transport_->beneath(of_each_point(low_points_).receivers(), bands, of_points);
      const Station& on_low = add(of_slots.through(at_points));
      steps_.push_back({"receivers", *filtered, on_low, inside});
      filtered = &on_low;
    }
    // Round one estimate alone: what rounds two has nothing in common.
    const Station &exact = add(Station(at_points(of_slots.first))),
                  &rounded = add(Station(at_points(rounded_to(input_.asset, of_slots.first))));
    steps_.push_back({"bits", exact, rounded, inside});
    stored_ = &add(Station(looked_up_in(input_.asset)));
    steps_.push_back({"subsurface", *filtered, *stored_, inside, "bits"});
    steps_.push_back({"seams", stood, *stored_, StepPoints::at_borders});
    progress_(0.9);
  }

  const SplitInput& input_;
  const ProgressFunction& progress_;
  const ErrorSamples samples_;
  const std::vector<std::uint32_t> slots_;
  const PointList high_points_, low_points_;  // of the slots
  const Paint paint_;
  const SplitLight light_;
  const SplitTransport transport_;
  std::optional<SplitTransport> low_transport_;  ///< where the bake's receivers are on the low mesh
  std::deque<Station> stations_;                 ///< whose addresses stay
  std::vector<CauseStep> steps_;
  const Station *seen_in_all_bands_ = nullptr, *seen_ = nullptr, *stored_ = nullptr;
  std::optional<CauseStep> at_vertices_, unshadowed_;  ///< steps on other ways
  ErrorSplit split_;
};

}  // namespace

double ErrorSplit::root_sum() const {
  double sum = 0;
  for (const ErrorCause& cause : causes) sum += cause.error * cause.error;
  return std::sqrt(sum);
}

int reference_bands(int asset_bands) { return std::max(fewest_reference_bands, 2 * asset_bands); }

ErrorSplit error_causes(const SplitInput& input, const ProgressFunction& progress) {
  return SplitWay(input, progress).measure();
}

Json to_json(const ErrorSplit& split) {
  Json causes = Json::object(), squares = {{"seen", split.seen}, {"total", split.squares}};
  for (const ErrorCause& cause : split.causes) {
    causes[cause.name] = cause.error;
    if (!cause.squares.empty()) squares[cause.name] = cause.squares;
  }
  Json json = {{"total", split.total},
               {"uncertainty", split.uncertainty},
               {"causes", causes},
               {"root_sum_of_causes", split.root_sum()},
               {"squares_by_band", squares},
               {"samples", split.samples},
               {"reference_directions", split.directions},
               {"reference_bands", split.bands}};
  const auto add = [&](const char* name, const std::optional<ErrorCause>& cause) {
    if (cause) json[name] = {{"error", cause->error}, {"squares_by_band", cause->squares}};
  };
  add("at_vertices", split.at_vertices);
  add("unshadowed", split.unshadowed);
  return json;
}

}  // namespace kiln
