// SPDX-License-Identifier: GPL-3.0-or-later
#include "compress/compress.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <optional>

#include "base/errors.h"
#include "base/json.h"
#include "base/number_text.h"
#include "base/stopwatch.h"
#include "compress/compress_files.h"

namespace kiln {

namespace {

constexpr std::size_t judged_texels = 65536;  // texels that steps are chosen on
constexpr int planes_per_lookup = 4;
constexpr int most_clusters = 256;
constexpr double rounding_allowance =
    1.25;                       // error of a stored model relative to the model's residual, where the error is free
constexpr double reach = 0.97;  // a model whose residual exceeds this share of the target has no room for rounding

std::uint64_t size_of(const EncodedFiles& files) {
  std::uint64_t bytes = 0;
  for (const auto& file : files) bytes += file.second.size();
  return bytes;
}

/// Search for the cheapest candidate; candidates are tried one after another.
class Search {
 public:
  Search(const PrtAsset& asset, const CompressSettings& settings, ProgressFunction progress)
      : asset_(asset),
        settings_(settings),
        progress_(std::move(progress)),
        source_(asset),
        owners_(gutter_owners(source_, settings.gutter)),
        sample_(source_.sample(judged_texels)),
        sample_vectors_(source_.vectors(sample_)),
        all_(principal_components(source_)) {}

  CompressResult run() {
    const bool free = settings_.clusters == 0 && settings_.components == 0;
    const CompressCandidate eight = plain(8);
    result_.plain = eight;
    if (asset_.bits == 8) result_.plain.error = rounding_error();
    result_.target_error = settings_.max_error.value_or(result_.plain.error);
    if (settings_.components > source_.length())
      throw WrongUsage(fmt::format("pca: found {}; expected at most {}, the length of a transfer vector",
                                   settings_.components, source_.length()));
    if (free) {
      consider(eight, nullptr);
      if (asset_.bits == 16) consider(plain(16), nullptr);
    }
    if (settings_.clusters <= 1) try_one_basis();
    progress_(0.2);
    if (settings_.clusters != 1) try_clusters();
    if (!best_) fail();
    finish();
    return std::move(result_);
  }

 private:
  double error_of(double residual) const {
    return source_.squared_norm() > 0 ? std::sqrt(std::max(residual, 0.0) / source_.squared_norm()) : 0;
  }

  /// Returns the error of rounding to the steps of the asset's own planes: step^2 / 12 in every entry.
  double rounding_error() const {
    double sum = 0;
    for (std::size_t k = 0; k < asset_.planes.size(); ++k) {
      const double step = source_.scale()[static_cast<Eigen::Index>(k)] * asset_.planes[k].range.step(asset_.bits);
      sum += step * step / 12;
    }
    return error_of(sum * static_cast<double>(source_.covered().size()));
  }

  CompressCandidate plain(int bits) const {
    CompressCandidate candidate;
    candidate.components = static_cast<int>(asset_.planes.size());
    candidate.bits = bits;
    if (bits < asset_.bits) {
      const ErrorSpread spread = spread_of_decoded(with_eight_bits(asset_), source_);
      candidate.error = spread.mean;
      candidate.texel_error = spread.texel;
    }
    candidate.bytes = size_of(encode_planes(asset_, bits, PngEffort::quick));
    candidate.lookups = candidate.lookups_at_borders =
        (candidate.components + planes_per_lookup - 1) / planes_per_lookup;
    return candidate;
  }

  /// Records a candidate, and `model` with it if it is the cheapest so far; tells whether it is.
  bool consider(CompressCandidate candidate, const TexelModel* model) {
    candidate.feasible = candidate.error <= result_.target_error && (is_fixed() || is_bounded(candidate));
    note(candidate);
    if (!candidate.feasible || (best_ && best_->bytes <= candidate.bytes)) return false;
    best_ = candidate;
    best_model_ = model != nullptr ? std::optional(*model) : std::nullopt;
    return true;
  }

  /// Adds a candidate to those tried; it replaces the same model from before it settled.
  void note(const CompressCandidate& candidate) {
    const auto same = std::find_if(result_.tried.begin(), result_.tried.end(), [&](const CompressCandidate& other) {
      return other.scheme == candidate.scheme && other.scheme != CompressScheme::planes &&
             other.clusters == candidate.clusters && other.components == candidate.components;
    });
    if (same == result_.tried.end())
      result_.tried.push_back(candidate);
    else if (candidate.feasible && (!same->feasible || candidate.bytes < same->bytes))
      *same = candidate;
  }

  /// Tells whether the settings leave no choice of a model: its worst errors are then reported, not bounded.
  bool is_fixed() const { return settings_.clusters > 0 && settings_.components > 0; }

  static bool is_bounded(const CompressCandidate& candidate) {
    return candidate.texel_error <= most_texel_error && candidate.border_jump <= most_border_jump;
  }

  /// Tells whether a model's worst residuals leave no room for rounding. With one basis a sample decides.
  bool leaves_worse(const TexelModel& model) const {
    if (is_fixed()) return false;
    const ErrorSpread left =
        model.model.clusters() == 1
            ? error_spread(source_, vector_errors(model, 0), sample_vectors_, sample_)
            : error_spread(source_, stored_errors(source_, model, 0), std::span<const std::uint8_t>(model.ids));
    return left.texel > reach * most_texel_error || left.border > reach * most_border_jump;
  }

  /// Step for the weights of a model, and the model's residual without rounding.
  struct Step {
    double step = 0;  ///< 0: no step stays within the target
    double left = 0;

    /// Estimates the step that reaches `aim` if step `at` gives `error`: rounding adds squares of steps, nearly.
    double towards(double aim, double at, double error) const {
      return at * std::sqrt(std::max(0.01, (aim * aim - left * left) / (error * error - left * left)));
    }
  };

  /// Finds the largest step that stays within the target, on the sample.
  Step step_for(const TexelModel& model, double target) const {
    const auto error_at = [&](double step) {
      const TexelModel rounded{step > 0 ? rounded_model(model.model, source_, all_, step) : model.model, model.ids, {}};
      return error_spread(source_, vector_errors(rounded, step), sample_vectors_, sample_).mean;
    };
    constexpr double nearly = 0.998, aim = 0.999;  // relative to the target
    constexpr int most_tries = 12;
    Step found{0, error_at(0)};
    if (found.left >= target) return found;
    // Largest possible error of a step's rounding: step^2 / 12 per component.
    const double room = std::sqrt(source_.squared_norm() / static_cast<double>(source_.covered().size())) *
                        std::sqrt(target * target - found.left * found.left);
    double step = room * std::sqrt(12.0 / std::max(1, model.model.components)), high = 0;
    for (int k = 0; k < most_tries && step > 0; ++k) {
      const double error = error_at(step);
      (error <= target ? found.step : high) = step;
      if (error >= nearly * target && error <= target) break;
      double next = error > found.left ? found.towards(aim * target, step, error) : 2 * step;
      if (high > 0 && (next <= found.step || next >= high)) next = (found.step + high) / 2;
      if (high > 0 && found.step > nearly * high) break;
      step = next;
    }
    return found;
  }

  /// Tries a model with steps as coarse as the target allows, measured on all texels; tells whether it is the cheapest
  /// so far.
  bool attempt(const TexelModel& model, CompressScheme scheme) {
    return attempt(model, scheme, result_.target_error, !is_fixed());
  }

  bool attempt(const TexelModel& model, CompressScheme scheme, double target, bool bounds_worst) {
    const Step found = step_for(model, target);
    double step = found.step;
    if (step == 0) return false;
    constexpr int most_tries = 12;
    for (int k = 0; k < most_tries; ++k) {
      CompressCandidate candidate;
      const TexelModel rounded{rounded_model(model.model, source_, all_, step), model.ids, {}};
      const ErrorSpread spread = error_spread(
          source_, stored_errors(source_, rounded, step),
          model.model.clusters() > 1 ? std::span<const std::uint8_t>(model.ids) : std::span<const std::uint8_t>());
      candidate.error = spread.mean;
      candidate.texel_error = spread.texel;
      candidate.border_jump = spread.border;
      const bool is_worse = bounds_worst && !is_bounded(candidate);
      if ((candidate.error > target || is_worse) && k + 1 < most_tries) {
        // The sample was too favourable: take a smaller step.
        step *= is_worse ? 0.85 : std::clamp(found.towards(0.9995 * target, 1, candidate.error), 0.9, 0.999);
        continue;
      }
      const StoredPca stored = store_pca(source_, model, all_, step);
      describe(stored, scheme, step, candidate);
      candidate.bytes = size_of(encode_pca(stored, source_, PngEffort::quick));
      return consider(candidate, &model);
    }
    return false;
  }

  static void describe(const StoredPca& stored, CompressScheme scheme, double step, CompressCandidate& candidate) {
    candidate.scheme = scheme;
    candidate.clusters = stored.decoded.model.clusters();
    candidate.components = stored.decoded.model.components;
    candidate.step = step;
    for (const StoredPicture& plane : stored.weights) candidate.bits = std::max(candidate.bits, plane.bits);
    const int layers = (candidate.components + planes_per_lookup - 1) / planes_per_lookup;
    candidate.lookups = candidate.clusters == 1 ? layers : 1 + layers;
    candidate.lookups_at_borders = candidate.clusters == 1 ? layers : 1 + 4 * layers;
  }

  /// Tries a model whose residual exceeds the target, with steps that fit its residual, to show what more error would
  /// save. Tells whether it is the cheapest so far all the same: rounded, it may keep the bounds that it missed as it
  /// was.
  bool attempt_lacking(const TexelModel& model, CompressScheme scheme, double left) {
    return attempt(model, scheme, rounding_allowance * left, false);
  }

  void note_lacking(double error) { least_error_ = std::min(least_error_.value_or(error), error); }

  /// Tries one basis: as many components as are worth their bits, then fewer or more as long as that saves bytes.
  void try_one_basis() {
    const int length = source_.length();
    const auto feasible = [&](int n) {
      const double error = error_of(all_.residual[static_cast<std::size_t>(n)]);
      if (error > reach * result_.target_error) note_lacking(error);
      return error <= reach * result_.target_error &&
             (n == length || !leaves_worse(texel_model(source_, all_.model(n), owners_)));
    };
    if (settings_.components > 0) {
      raise_target(error_of(all_.residual[static_cast<std::size_t>(settings_.components)]));
      if (feasible(settings_.components)) attempt_plain(settings_.components);
      return;
    }
    int fewest = 1;
    while (fewest < length && !feasible(fewest)) ++fewest;
    for (const int n : {fewest / 2, fewest / 4})
      if (n > 0)
        attempt_lacking(texel_model(source_, all_.model(n), owners_), CompressScheme::pca,
                        error_of(all_.residual[static_cast<std::size_t>(n)]));
    if (!feasible(fewest)) return;
    const int first = std::max(fewest, components_worth_bits());
    attempt_plain(first);
    int n = first;
    while (n < length && attempt_plain(n + 1)) ++n;
    if (n > first) return;
    while (n > fewest && attempt_plain(n - 1)) --n;
  }

  /// Counts the components whose variance exceeds the error of rounding their weights, where both together reach the
  /// target (reverse water-filling; [Cover 2006], section 10.3.3).
  int components_worth_bits() const {
    const double allowed = result_.target_error * result_.target_error * source_.squared_norm();
    int n = source_.length();
    while (n > 1) {
      const auto kept = static_cast<std::size_t>(n);
      const double rounding = (allowed - all_.residual[kept]) / n;  // error per component if n are kept
      if (all_.variances[n - 1] > rounding) break;
      --n;
    }
    return n;
  }

  bool attempt_plain(int components) {
    return attempt(texel_model(source_, all_.model(components), owners_), CompressScheme::pca);
  }

  /// Raises the target where the settings fix the model and leave the error open: to the model's residual and a quarter
  /// more for rounding.
  void raise_target(double left) {
    if (is_fixed() && !settings_.max_error)
      result_.target_error = std::max(result_.target_error, rounding_allowance * left);
  }

  /// Outcome of trying a model: it lacks room for rounding, is worse than the best, or is the best.
  enum class Outcome { lacks, worse, best };
  struct Attempt {
    Outcome outcome = Outcome::lacks;
    double left = 0;
  };
  Attempt attempt_clusters(int clusters, int components) {
    if (clusters != starts_clusters_) start_ = cluster_texels(source_, clusters, settings_.seed);
    starts_clusters_ = clusters;
    ClusteredPca clustered = clustered_pca(source_, all_, start_, components);
    if (is_fixed()) improve(source_, all_, clustered);
    const double left = error_of(clustered.residual);
    raise_target(left);
    const TexelModel model = texel_model(source_, clustered, owners_);
    if (left > reach * result_.target_error || leaves_worse(model)) {
      if (left > reach * result_.target_error) note_lacking(left);
      if (attempt_lacking(model, CompressScheme::clustered_pca, left)) best_clusters_ = std::move(clustered);
      return {Outcome::lacks, left};
    }
    if (!attempt(model, CompressScheme::clustered_pca)) return {Outcome::worse, left};
    best_clusters_ = std::move(clustered);
    return {Outcome::best, left};
  }

  Outcome attempt_once(int clusters, int components) {
    const auto [place, is_new] = attempted_.try_emplace({clusters, components});
    if (is_new) {
      place->second = attempt_clusters(clusters, components);
      progress_(std::min(0.85, 0.2 + 0.06 * static_cast<double>(attempted_.size())));
    }
    return place->second.outcome;
  }

  /// Estimates the number of components at which so many clusters just reach the target: errors fall by about the same
  /// factor with each further component, that of the two attempts nearest to it.
  int expected_components(int clusters) const {
    constexpr double usual_fall = 0.25;  // of the error's logarithm, per component
    std::vector<std::pair<int, double>> known;
    for (const auto& [key, attempt] : attempted_)
      if (key.first == clusters && attempt.left > 0) known.emplace_back(key.second, std::log(attempt.left));
    if (known.empty()) return 4;
    const double aim = std::log(reach * result_.target_error);
    std::stable_sort(known.begin(), known.end(),
                     [&](const auto& a, const auto& b) { return std::abs(a.second - aim) < std::abs(b.second - aim); });
    const auto& [n, left] = known.front();
    double fall = usual_fall;
    if (known.size() > 1) fall = (left - known[1].second) / (known[1].first - n);
    return n + static_cast<int>(std::ceil((left - aim) / std::max(fall, 0.02)));
  }

  /// Finds the fewest components whose residual is below the target with so many clusters; none where even `most` are
  /// not enough. Tries `first` first, if given.
  std::optional<int> fewest_components(int clusters, int most, std::optional<int> first) {
    int low = 0, high = most + 1;  // low is not enough, high is
    while (high - low > 1) {
      const int n =
          std::clamp(low == 0 && high > most && first ? *first : expected_components(clusters), low + 1, high - 1);
      (attempt_once(clusters, n) == Outcome::lacks ? low : high) = n;
    }
    return high <= most ? std::optional(high) : std::nullopt;
  }

  /// Tries clusters, halving their number in turn: for each the fewest components that reach the target, and more as
  /// long as that saves bytes. Bytes first fall with components, as steps get coarser, then rise; the same holds for
  /// clusters.
  void try_clusters() {
    const bool is_free = settings_.clusters == 0;
    if (settings_.components > 0) {
      for (const int k : is_free ? std::vector{256, 128, 64} : std::vector{settings_.clusters})
        if (attempt_once(k, settings_.components) == Outcome::lacks) break;
      return;
    }
    constexpr int most_components = 24, further_components = 4, fewest_clusters = 16;
    const int most = std::min(source_.length() - 1, most_components);
    std::optional<int> fewest;
    for (int k = is_free ? most_clusters : settings_.clusters; most > 0 && k >= 2; k /= 2) {
      if (fewest) fewest = std::min(most, *fewest + 1);
      fewest = fewest_components(k, most, fewest);
      if (!fewest) break;
      bool is_best = attempt_once(k, *fewest) == Outcome::best;
      for (int n = *fewest + 1; n <= std::min(most, *fewest + further_components); ++n) {
        const bool is_better = attempt_once(k, n) == Outcome::best;
        is_best |= is_better;
        if (!is_better) break;
      }
      if (!is_free || !is_best || k / 2 < fewest_clusters) break;
    }
  }

  [[noreturn]] void fail() const {
    if (!least_error_)
      throw WrongUsage(fmt::format(
          "{}: leaves texels or borders of clusters that show, errors beyond {} of 999 in 1,000 texels or jumps "
          "beyond {} at borders; expected more, or auto",
          settings_.clusters > 0 ? fmt::format("clusters: found {}, which", settings_.clusters)
                                 : fmt::format("pca: found {}, which", settings_.components),
          most_texel_error, most_border_jump));
    throw WrongUsage(
        fmt::format("max-error: found {}; expected at least {:.3g}, which --clusters and --pca as they are "
                    "leave; allow more error, clusters or components",
                    settings_.max_error ? numbers_text({*settings_.max_error}) : "auto", *least_error_ / reach));
  }

  /// Improves the cheapest candidate by further rounds, if it has clusters; keeps the old one where that saves nothing.
  void improve_best() {
    if (is_fixed() || best_->scheme != CompressScheme::clustered_pca) return;
    improve(source_, all_, *best_clusters_);
    attempt(texel_model(source_, *best_clusters_, owners_), CompressScheme::clustered_pca);
  }

  /// Encodes the cheapest candidate as small as possible.
  void finish() {
    progress_(0.85);
    improve_best();
    progress_(0.9);
    result_.chosen = *best_;
    if (best_model_) {
      result_.files = encode_pca(store_pca(source_, *best_model_, all_, best_->step), source_, PngEffort::thorough);
      result_.border_share = border_share(*best_model_);
    } else {
      result_.files = encode_planes(asset_, best_->bits, PngEffort::thorough);
    }
    result_.chosen.bytes = size_of(result_.files);
    if (!is_bounded(*best_))
      result_.warnings.push_back(
          fmt::format("{} clusters of {} components leave errors that show: 1 in 1,000 texels is off by more than "
                      "{:.3f} (bound {}), "
                      "or jumps at clusters' borders by more than {:.3f} (bound {}); take more of either, or auto",
                      best_->clusters, best_->components, best_->texel_error, most_texel_error, best_->border_jump,
                      most_border_jump));
    progress_(1);
  }

  double border_share(const TexelModel& model) const {
    if (model.model.clusters() == 1) return 0;
    const auto width = static_cast<std::size_t>(asset_.width);
    std::size_t borders = 0;
    for (const std::uint32_t texel : source_.covered()) {
      const std::size_t right = texel % width + 1 < width ? texel + 1 : texel,
                        above = texel + width < model.ids.size() ? texel + width : texel;
      borders += model.ids[texel] != model.ids[right] || model.ids[texel] != model.ids[above];
    }
    return static_cast<double>(borders) / static_cast<double>(source_.covered().size());
  }

  const PrtAsset& asset_;
  const CompressSettings& settings_;
  ProgressFunction progress_;
  TransferSource source_;
  std::vector<std::uint32_t> owners_, sample_;
  Eigen::MatrixXf sample_vectors_;
  PrincipalComponents all_;
  TexelClusters start_;      ///< for the number of clusters tried last:
  int starts_clusters_ = 0;  ///< this many
  CompressResult result_;
  std::optional<CompressCandidate> best_;
  std::optional<TexelModel> best_model_;              ///< none: planes
  std::optional<ClusteredPca> best_clusters_;         ///< clusters of that model, if it has several
  std::optional<double> least_error_;                 ///< least residual among models that exceed the target
  std::map<std::pair<int, int>, Attempt> attempted_;  ///< by clusters and components
};

/// Throws BadInput for transfer whose squares are beyond floats, so that no error could be told.
void check_ranges(const PrtAsset& asset) {
  constexpr double least = 1e-12, most = 1e12;
  double largest = 0;
  for (const PrtPlane& plane : asset.planes)
    largest = std::max({largest, std::abs(plane.range.lowest), std::abs(plane.range.highest)});
  if (largest == 0 || (largest >= least && largest <= most)) return;
  throw BadInput(asset.ranges_file.string(), fmt::format("the largest value of transfer is {:g}", largest),
                 "0, or 1e-12 to 1e+12 (an unoccluded texel has 0.282095)", "bake the asset again with kiln-bake");
}

}  // namespace

std::string scheme_name(CompressScheme scheme) {
  if (scheme == CompressScheme::planes) return "planes";
  return scheme == CompressScheme::pca ? "pca" : "clustered-pca";
}

Json CompressCandidate::to_json() const {
  return {{"scheme", scheme_name(scheme)},
          {"clusters", clusters},
          {"components", components},
          {"bits", bits},
          {"step", step},
          {"error", error},
          {"texel_error", texel_error},
          {"border_jump", border_jump},
          {"bytes", bytes},
          {"lookups", lookups},
          {"lookups_at_borders", lookups_at_borders},
          {"feasible", feasible}};
}

CompressResult compress(const PrtAsset& asset, const CompressSettings& settings, const ProgressFunction& progress) {
  if (asset.clusters)
    throw BadInput(asset.ranges_file.string(), "is a compressed asset", "the output folder of kiln-bake",
                   "compress the baked folder itself");
  check_ranges(asset);
  const Stopwatch watch;
  CompressResult result = Search(asset, settings, progress).run();
  result.seconds = watch.seconds();
  return result;
}

}  // namespace kiln
