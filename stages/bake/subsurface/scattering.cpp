#include "bake/subsurface/scattering.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "bake/subsurface/kernel_tables.h"
#include "bake/subsurface/sample_octree.h"

namespace kiln {

namespace {

constexpr int chunk_coefficients = 32;  // summed at a time, which bounds memory for many bands
constexpr std::size_t block_receivers = 64;

/// Samples whose normals are further apart than this stand on the other side of something thin, not around a crease.
constexpr float same_side_cosine = -0.5f;

/// Discs much smaller than the others are as good as points.
constexpr float least_radius_share = 1e-3f;

/// Where a sum of a few hundred kernels is known to that accuracy, more than all means more than this.
constexpr float most_gain = 1.0f;

float radius_of(float area) { return std::sqrt(area * 0.318309886f); }

/// One disc, along the octree's order.
struct Sample {
  Eigen::Vector3f position;
  Eigen::Vector3f normal;
  float area = 0;
  float radius = 0;  ///< for the kernels, not below least_radius_share of the largest
};

/// Sums of kernels times vectors over the samples. Vectors are `inputs` channels of `width` numbers each, row after row
/// along the octree's order.
class KernelSums {
 public:
  KernelSums(const SampleOctree& tree, const std::vector<Sample>& samples, const KernelTables& kernels)
      : tree_(tree), samples_(samples), kernels_(kernels), channels_(kernels.channels()) {}

  /// `gains`: by sample and channel, what its vector is scaled with. Keeps references to both.
  void set_vectors(const std::vector<float>& rows, std::size_t inputs, int width, const std::vector<float>& gains) {
    rows_ = rows.data();
    inputs_ = inputs;
    width_ = static_cast<std::size_t>(width);
    gains_ = gains.data();
    node_sums_.assign(tree_.nodes.size() * channels_ * width_, 0.f);
    for (std::size_t node = tree_.nodes.size(); node-- > 0;) {
      const SampleOctree::Node& own = tree_.nodes[node];
      float* const sums = node_sums_.data() + node * channels_ * width_;
      if (own.is_leaf)
        for (std::uint32_t k = own.first; k < own.last; ++k)
          for (std::size_t c = 0; c < channels_; ++c)
            add(sums + c * width_, samples_[k].area * gains_[k * channels_ + c], row(k, c));
      if (node > 0) {
        float* const parent = node_sums_.data() + own.parent * channels_ * width_;
        for (std::size_t i = 0; i < channels_ * width_; ++i) parent[i] += sums[i];
      }
    }
  }

  struct Scratch {
    std::vector<float> sums, near, near_weights, kernel;
  };

  /// What arrives at sample `p`: channels times width numbers in `scratch.sums`.
  void evaluate(std::uint32_t p, float solid_angle, Scratch& scratch) const {
    const Sample& to = samples_[p];
    const float near_distance = KernelTables::near_reach * to.radius;
    scratch.sums.assign(channels_ * width_, 0.f);
    scratch.near.assign(channels_ * width_, 0.f);
    scratch.near_weights.assign(channels_, 0.f);
    scratch.kernel.resize(channels_);

    // Step 1: the octree, a node as a whole where it is far and small enough.
    for (std::uint32_t at = 0; at < tree_.nodes.size();) {
      const SampleOctree::Node& node = tree_.nodes[at];
      const float squared = (node.centre - to.position).squaredNorm();
      if (node.area <= solid_angle * squared && squared_distance(node, to.position) > near_distance * near_distance) {
        kernels_.density(squared, scratch.kernel.data());
        const float* const sums = node_sums_.data() + at * channels_ * width_;
        for (std::size_t c = 0; c < channels_; ++c)
          add(scratch.sums.data() + c * width_, scratch.kernel[c], sums + c * width_);
        at = node.next;
        continue;
      }
      if (node.is_leaf)
        for (std::uint32_t q = node.first; q < node.last; ++q) add_sample(to, q, near_distance, scratch);
      ++at;
    }

    // Step 2: what is near, with a plane's energy.
    kernels_.near_total(to.radius, scratch.kernel.data());
    for (std::size_t c = 0; c < channels_; ++c)
      if (scratch.near_weights[c] > 0)
        add(scratch.sums.data() + c * width_, scratch.kernel[c] / scratch.near_weights[c],
            scratch.near.data() + c * width_);
  }

 private:
  const float* row(std::size_t k, std::size_t channel) const {
    return rows_ + (k * inputs_ + (inputs_ == 1 ? 0 : channel)) * width_;
  }

  void add(float* sums, float weight, const float* vector) const {
    for (std::size_t i = 0; i < width_; ++i) sums[i] += weight * vector[i];
  }

  void add_sample(const Sample& to, std::uint32_t q, float near_distance, Scratch& scratch) const {
    const Sample& from = samples_[q];
    const float squared = (from.position - to.position).squaredNorm();
    const float distance = std::sqrt(squared);
    const bool same_side = from.normal.dot(to.normal) > same_side_cosine;
    const bool near = same_side && distance < near_distance;
    float* const kernel = scratch.kernel.data();
    if (same_side)
      kernels_.disc_mean(from.radius, distance, kernel);
    else
      kernels_.density(squared + 0.5f * from.radius * from.radius, kernel);  // a disc across: its mean square
    const float share = near ? KernelTables::near_share(distance, to.radius) : 0.f;
    for (std::size_t c = 0; c < channels_; ++c) {
      const float weight = kernel[c] * from.area, gain = gains_[q * channels_ + c];
      add(scratch.sums.data() + c * width_, weight * (1 - share) * gain, row(q, c));
      if (!near) continue;
      add(scratch.near.data() + c * width_, weight * share * gain, row(q, c));
      scratch.near_weights[c] += weight * share;
    }
  }

  const SampleOctree& tree_;
  const std::vector<Sample>& samples_;
  const KernelTables& kernels_;
  std::size_t channels_;
  const float* rows_ = nullptr;
  std::size_t inputs_ = 1, width_ = 0;
  const float* gains_ = nullptr;
  std::vector<float> node_sums_;
};

/// Calls keep(sample along the order, its sums) for every sample, from any thread.
template <class Keep>
void evaluate_all(const KernelSums& sums, std::size_t samples, float solid_angle, const ProgressFunction& progress,
                  const Keep& keep) {
  constexpr std::size_t slice = 64 * block_receivers;
  for (std::size_t first = 0; first < samples; first += slice) {
    const std::size_t last = std::min(samples, first + slice);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(first, last, block_receivers), [&](const auto& range) {
      KernelSums::Scratch scratch;
      for (std::size_t p = range.begin(); p != range.end(); ++p) {
        sums.evaluate(static_cast<std::uint32_t>(p), solid_angle, scratch);
        keep(p, scratch.sums);
      }
    });
    progress(static_cast<double>(last) / static_cast<double>(samples));
  }
}

std::vector<Sample> ordered_samples(const SurfaceSamples& samples, const SampleOctree& tree) {
  const float largest = radius_of(*std::max_element(samples.areas.begin(), samples.areas.end()));
  std::vector<Sample> ordered;
  ordered.reserve(samples.size());
  for (std::uint32_t index : tree.order) {
    const float area = samples.areas[index];
    ordered.push_back({samples.positions[index], samples.normals[index], area,
                       std::max(radius_of(area), least_radius_share * largest)});
  }
  return ordered;
}

/// `count` coefficients of every channel from `first` on, row after row along the order.
std::vector<float> gather_rows(const std::vector<TransferVectors>& incoming, const SampleOctree& tree, int first,
                               int count) {
  const std::size_t row = incoming.size() * static_cast<std::size_t>(count);
  std::vector<float> rows(tree.order.size() * row);
  for (std::size_t c = 0; c < incoming.size(); ++c)
    for (int i = 0; i < count; ++i) {
      const std::span<const float> plane = incoming[c].plane(first + i);
      for (std::size_t k = 0; k < tree.order.size(); ++k)
        rows[k * row + c * static_cast<std::size_t>(count) + static_cast<std::size_t>(i)] = plane[tree.order[k]];
    }
  return rows;
}

void check(const SurfaceSamples& samples, const std::vector<TransferVectors>& incoming,
           std::span<const ScatterProfile> profiles) {
  const bool fits = !profiles.empty() && (incoming.size() == 1 || incoming.size() == profiles.size()) &&
                    samples.size() > 0 && samples.normals.size() == samples.size() &&
                    samples.areas.size() == samples.size();
  if (!fits) throw std::invalid_argument("scatter_transfer: samples, channels and profiles do not go together");
  for (const TransferVectors& channel : incoming)
    if (channel.receivers != samples.size() || channel.coefficients != incoming[0].coefficients)
      throw std::invalid_argument("scatter_transfer: one transfer vector per sample and channel is needed");
  if (!(*std::max_element(samples.areas.begin(), samples.areas.end()) > 0))
    throw std::invalid_argument("scatter_transfer: the samples have no area");
}

ProgressFunction part_of(const ProgressFunction& progress, double from, double to) {
  return [&progress, from, to](double fraction) { progress(from + (to - from) * fraction); };
}

}  // namespace

Scattering scatter_transfer(const SurfaceSamples& samples, const std::vector<TransferVectors>& incoming,
                            std::span<const ScatterProfile> profiles, const ScatteringSettings& settings,
                            const ProgressFunction& progress) {
  check(samples, incoming, profiles);
  const std::size_t channels = profiles.size(), count = samples.size();
  const auto solid_angle = static_cast<float>(settings.solid_angle);
  const int coefficients = incoming[0].coefficients;

  // Step 1: the octree, and the kernels for the samples in it.
  const SampleOctree tree(samples);
  const std::vector<Sample> ordered = ordered_samples(samples, tree);
  const auto [least, most] = std::minmax_element(ordered.begin(), ordered.end(),
                                                 [](const Sample& a, const Sample& b) { return a.radius < b.radius; });
  const SampleOctree::Node& root = tree.nodes.front();
  const double farthest = (root.upper - root.lower).norm() + KernelTables::near_reach * most->radius;
  const KernelTables kernels(profiles, least->radius, most->radius, farthest);
  KernelSums sums(tree, ordered, kernels);

  // Step 2: what every sample sends out of what it gets, which the kernel's symmetry makes what it would get from a
  // surface that sends 1 everywhere.
  Scattering result;
  std::vector<float> gains(count * channels, 1.f);
  {
    const std::vector<float> ones(count, 1.f);
    sums.set_vectors(ones, 1, 1, gains);
    std::vector<float> sent(count * channels);
    evaluate_all(sums, count, solid_angle, part_of(progress, 0, 0.2),
                 [&](std::size_t p, const std::vector<float>& all) {
                   std::copy(all.begin(), all.end(), sent.begin() + static_cast<std::ptrdiff_t>(p * channels));
                 });
    for (std::size_t k = 0; k < sent.size(); ++k) gains[k] = sent[k] > most_gain ? most_gain / sent[k] : 1.f;
    result.largest_gain = *std::max_element(sent.begin(), sent.end());
    double all_area = 0;
    std::vector<double> capped(channels, 0);
    for (std::size_t k = 0; k < count; ++k) {
      all_area += ordered[k].area;
      for (std::size_t c = 0; c < channels; ++c) capped[c] += gains[k * channels + c] < 1 ? ordered[k].area : 0;
    }
    result.capped_area = *std::max_element(capped.begin(), capped.end()) / all_area;
  }

  // Step 3: the transfer, some coefficients at a time; at some points also by every sample.
  result.transfer.assign(channels, TransferVectors(count, coefficients));
  result.error_points = std::min(settings.error_points, count);
  double squared_error = 0, squared_length = 0;
  for (int first = 0; first < coefficients; first += chunk_coefficients) {
    const int width = std::min(chunk_coefficients, coefficients - first);
    const std::vector<float> rows = gather_rows(incoming, tree, first, width);
    sums.set_vectors(rows, incoming.size(), width, gains);
    const auto put = [&](std::size_t p, const std::vector<float>& all) {
      for (std::size_t c = 0; c < channels; ++c)
        for (int i = 0; i < width; ++i)
          result.transfer[c].plane(first + i)[tree.order[p]] =
              all[c * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)];
    };
    evaluate_all(sums, count, solid_angle,
                 part_of(progress, 0.2 + 0.8 * first / coefficients, 0.2 + 0.8 * (first + width) / coefficients), put);

    std::vector<double> errors(result.error_points, 0), lengths(result.error_points, 0);
    tbb::parallel_for(std::size_t{0}, result.error_points, [&](std::size_t e) {
      const std::size_t p = e * count / result.error_points;
      KernelSums::Scratch scratch;
      sums.evaluate(static_cast<std::uint32_t>(p), 0.f, scratch);
      for (std::size_t c = 0; c < channels; ++c)
        for (int i = 0; i < width; ++i) {
          const double exact = scratch.sums[c * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)];
          const double off = result.transfer[c].plane(first + i)[tree.order[p]] - exact;
          errors[e] += off * off;
          lengths[e] += exact * exact;
        }
    });
    for (std::size_t e = 0; e < result.error_points; ++e) {
      squared_error += errors[e];
      squared_length += lengths[e];
    }
  }
  result.hierarchy_error = squared_length > 0 ? std::sqrt(squared_error / squared_length) : 0;

  // Step 4: the share of energy.
  for (std::size_t c = 0; c < channels; ++c) {
    double in = 0, out = 0;
    for (std::size_t k = 0; k < count; ++k) {
      in += static_cast<double>(samples.areas[k]) * incoming[incoming.size() == 1 ? 0 : c].plane(0)[k];
      out += static_cast<double>(samples.areas[k]) * result.transfer[c].plane(0)[k];
    }
    result.energy.push_back(in > 0 ? out / in : 0);
  }
  return result;
}

}  // namespace kiln
