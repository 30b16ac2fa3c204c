// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/subsurface/scattering.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "bake/subsurface/kernel_tables.h"
#include "bake/subsurface/sample_octree.h"
#include "base/parallel.h"

namespace kiln {

namespace {

constexpr int chunk_coefficients = 32;  // coefficients summed at a time; bounds memory for many bands
constexpr std::size_t block_receivers = 64;

/// Least cosine between the normals of two samples on one side; below it, one stands on the other side of a thin part,
/// not around a crease.
constexpr float same_side_cosine = -0.5f;

/// Least radius of a disc for the kernels, over the largest: smaller ones are as good as points.
constexpr float least_radius_share = 1e-3f;

/// Number of floats in a vector, to a multiple of which rows are padded.
constexpr int row_lanes = 4;

float radius_of(float area) { return std::sqrt(area * 0.318309886f); }

/// Sample of the surface as a disc, along the octree's order.
struct OrderedSample {
  Eigen::Vector3f position;
  Eigen::Vector3f normal;
  float area = 0;
  float radius = 0;  ///< radius for the kernels, at least least_radius_share of the largest
};

/// Weighted vectors on their way into sums: some at a time, so that they stay in the nearest cache while sums of a few
/// coefficients stay in registers.
class WeightedSum {
 public:
  WeightedSum(std::size_t channels, std::size_t width) : channels_(channels), width_(width), sums_(channels * width) {
    weights_.reserve(batch * channels);
  }

  /// Adds weights[c] times the `width` numbers at vector + c * stride.
  void add(const float* weights, const float* vector, std::size_t stride) {
    vectors_[size_] = {vector, stride};
    weights_.insert(weights_.end(), weights, weights + channels_);
    if (++size_ == batch) flush();
  }

  /// Scales the sums so far by channel and adds them to those of `other`.
  void add_to(WeightedSum& other, const float* factors) {
    flush();
    other.flush();
    for (std::size_t c = 0; c < channels_; ++c)
      for (std::size_t i = 0; i < width_; ++i) other.sums_[c * width_ + i] += factors[c] * sums_[c * width_ + i];
  }

  const std::vector<float>& sums() {
    flush();
    return sums_;
  }

  void clear() {
    size_ = 0;
    weights_.clear();
    std::fill(sums_.begin(), sums_.end(), 0.f);
  }

 private:
  static constexpr std::size_t batch = 64;

  struct Row {
    const float* first;
    std::size_t stride;
  };

  template <int lanes>
  void flush_lanes(std::size_t c, std::size_t i) {
    float kept[lanes];
    float* const sums = sums_.data() + c * width_ + i;
    std::copy_n(sums, lanes, kept);
    for (std::size_t k = 0; k < size_; ++k) {
      const float weight = weights_[k * channels_ + c];
      const float* const values = vectors_[k].first + c * vectors_[k].stride + i;
      for (int lane = 0; lane < lanes; ++lane) kept[lane] += weight * values[lane];
    }
    std::copy_n(kept, lanes, sums);
  }

  void flush() {
    std::size_t i = 0;
    for (; i + 16 <= width_; i += 16)
      for (std::size_t c = 0; c < channels_; ++c) flush_lanes<16>(c, i);
    for (; i < width_; i += row_lanes)
      for (std::size_t c = 0; c < channels_; ++c) flush_lanes<row_lanes>(c, i);
    size_ = 0;
    weights_.clear();
  }

  std::size_t channels_, width_, size_ = 0;
  std::array<Row, batch> vectors_;
  std::vector<float> weights_, sums_;
};

/// Sums of kernels times vectors over the samples. Vectors are `inputs` channels of `width` numbers each, a multiple of
/// row_lanes, row after row along the octree's order.
class KernelSums {
 public:
  KernelSums(const SampleOctree& tree, const std::vector<OrderedSample>& samples, const KernelTables& kernels)
      : tree_(tree), samples_(samples), kernels_(kernels), channels_(kernels.channels()) {}

  /// Keeps references to both. `gains` scale the vectors, by sample and channel; empty for 1.
  void set_vectors(const std::vector<float>& rows, std::size_t inputs, std::size_t width,
                   const std::vector<float>& gains) {
    rows_ = rows.data();
    inputs_ = inputs;
    width_ = width;
    gains_ = gains.empty() ? nullptr : gains.data();
    sum_channels_ = gains_ == nullptr ? inputs : channels_;
    const std::size_t row = sum_channels_ * width_;
    node_sums_.assign(tree_.nodes.size() * row, 0.f);
    for (std::size_t node = tree_.nodes.size(); node-- > 0;) {
      const SampleOctree::Node& own = tree_.nodes[node];
      float* const sums = node_sums_.data() + node * row;
      if (own.is_leaf)
        for (std::uint32_t k = own.first; k < own.last; ++k)
          for (std::size_t c = 0; c < sum_channels_; ++c) {
            const float weight = samples_[k].area * gain(k, c);
            const float* const vector = rows_ + (k * inputs_ + (inputs_ == 1 ? 0 : c)) * width_;
            for (std::size_t i = 0; i < width_; ++i) sums[c * width_ + i] += weight * vector[i];
          }
      if (node > 0) {
        float* const parent = node_sums_.data() + own.parent * row;
        for (std::size_t i = 0; i < row; ++i) parent[i] += sums[i];
      }
    }
  }

  struct Scratch {
    WeightedSum all, near;
    std::vector<float> kernel, weights, near_weights;

    explicit Scratch(const KernelSums& sums)
        : all(sums.channels_, sums.width_),
          near(sums.channels_, sums.width_),
          kernel(sums.channels_),
          weights(sums.channels_),
          near_weights(sums.channels_) {}
  };

  /// Returns what arrives at sample `p`: channels times width numbers, which stay in `scratch` until its next use.
  const std::vector<float>& evaluate(std::uint32_t p, float solid_angle, Scratch& scratch) const {
    const OrderedSample& to = samples_[p];
    const float near_distance = KernelTables::near_reach * to.radius;
    scratch.all.clear();
    scratch.near.clear();
    std::fill(scratch.near_weights.begin(), scratch.near_weights.end(), 0.f);

    // Step 1: add the octree, a node as a whole where it is far and small enough.
    for (std::uint32_t at = 0; at < tree_.nodes.size();) {
      const SampleOctree::Node& node = tree_.nodes[at];
      const float squared = (node.centre - to.position).squaredNorm();
      if (node.area <= solid_angle * squared && squared_distance(node, to.position) > near_distance * near_distance) {
        kernels_.density(squared, scratch.kernel.data());
        scratch.all.add(scratch.kernel.data(), node_sums_.data() + at * sum_channels_ * width_, stride(sum_channels_));
        at = node.next;
        continue;
      }
      if (node.is_leaf)
        for (std::uint32_t q = node.first; q < node.last; ++q) add_sample(to, q, near_distance, scratch);
      ++at;
    }

    // Step 2: add the samples nearby, with a plane's energy.
    kernels_.near_total(to.radius, scratch.kernel.data());
    for (std::size_t c = 0; c < channels_; ++c)
      scratch.weights[c] = scratch.near_weights[c] > 0 ? scratch.kernel[c] / scratch.near_weights[c] : 0.f;
    scratch.near.add_to(scratch.all, scratch.weights.data());
    return scratch.all.sums();
  }

 private:
  float gain(std::size_t k, std::size_t channel) const {
    return gains_ == nullptr ? 1.f : gains_[k * channels_ + channel];
  }

  /// Returns the distance from one channel's vector to the next's.
  std::size_t stride(std::size_t channels) const { return channels == 1 ? 0 : width_; }

  void add_sample(const OrderedSample& to, std::uint32_t q, float near_distance, Scratch& scratch) const {
    const OrderedSample& from = samples_[q];
    const float squared = (from.position - to.position).squaredNorm();
    const float distance = std::sqrt(squared);
    const bool same_side = from.normal.dot(to.normal) > same_side_cosine;
    const bool near = same_side && distance < near_distance;
    float* const kernel = scratch.kernel.data();
    if (same_side)
      kernels_.disc_mean(from.radius, distance, kernel);
    else
      kernels_.density(squared + 0.5f * from.radius * from.radius,
                       kernel);  // the mean square distance of a disc's points from its centre
    const float* const vector = rows_ + q * inputs_ * width_;
    const float share = near ? KernelTables::near_share(distance, to.radius) : 0.f;
    if (near) {
      for (std::size_t c = 0; c < channels_; ++c) {
        const float weight = kernel[c] * from.area * share;
        scratch.near_weights[c] += weight;
        scratch.weights[c] = weight * gain(q, c);
      }
      scratch.near.add(scratch.weights.data(), vector, stride(inputs_));
    }
    if (share == 1) return;
    for (std::size_t c = 0; c < channels_; ++c) scratch.weights[c] = kernel[c] * from.area * (1 - share) * gain(q, c);
    scratch.all.add(scratch.weights.data(), vector, stride(inputs_));
  }

  const SampleOctree& tree_;
  const std::vector<OrderedSample>& samples_;
  const KernelTables& kernels_;
  std::size_t channels_;
  const float* rows_ = nullptr;
  std::size_t inputs_ = 1, width_ = 0, sum_channels_ = 1;
  const float* gains_ = nullptr;
  std::vector<float> node_sums_;  // by node and, where gains or inputs differ by channel, channel
};

/// Calls keep(sample along the order, its sums) for every sample, from any thread.
template <class Keep>
void evaluate_all(const KernelSums& sums, std::size_t samples, float solid_angle, const ProgressFunction& progress,
                  const Keep& keep) {
  constexpr std::size_t slice = 64 * block_receivers;
  for (std::size_t first = 0; first < samples; first += slice) {
    const std::size_t last = std::min(samples, first + slice);
    parallel_ranges(first, last, block_receivers, [&](std::size_t begin, std::size_t end) {
      KernelSums::Scratch scratch(sums);
      for (std::size_t p = begin; p != end; ++p)
        keep(p, sums.evaluate(static_cast<std::uint32_t>(p), solid_angle, scratch));
    });
    progress(static_cast<double>(last) / static_cast<double>(samples));
  }
}

std::vector<OrderedSample> ordered_samples(const SurfaceSamples& samples, const SampleOctree& tree) {
  const float largest = radius_of(*std::max_element(samples.areas.begin(), samples.areas.end()));
  std::vector<OrderedSample> ordered;
  ordered.reserve(samples.size());
  for (std::uint32_t index : tree.order) {
    const float area = samples.areas[index];
    ordered.push_back({samples.positions[index], samples.normals[index], area,
                       std::max(radius_of(area), least_radius_share * largest)});
  }
  return ordered;
}

std::size_t padded(int count) { return static_cast<std::size_t>((count + row_lanes - 1) / row_lanes * row_lanes); }

/// Returns `count` coefficients of every channel from `first` on, padded with zeros, row after row along the order.
std::vector<float> gather_rows(const std::vector<TransferVectors>& incoming, const SampleOctree& tree, int first,
                               int count) {
  const std::size_t width = padded(count), row = incoming.size() * width;
  std::vector<float> rows(tree.order.size() * row, 0.f);
  for (std::size_t c = 0; c < incoming.size(); ++c)
    for (int i = 0; i < count; ++i) {
      const std::span<const float> plane = incoming[c].plane(first + i);
      for (std::size_t k = 0; k < tree.order.size(); ++k)
        rows[k * row + c * width + static_cast<std::size_t>(i)] = plane[tree.order[k]];
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

/// Makes kernels for all distances between the samples of a tree.
KernelTables make_kernels(std::span<const ScatterProfile> profiles, const SampleOctree& tree,
                          const std::vector<OrderedSample>& ordered) {
  const auto [least, most] =
      std::minmax_element(ordered.begin(), ordered.end(),
                          [](const OrderedSample& a, const OrderedSample& b) { return a.radius < b.radius; });
  const SampleOctree::Node& root = tree.nodes.front();
  const double farthest = (root.upper - root.lower).norm() + KernelTables::near_reach * most->radius;
  return KernelTables(profiles, least->radius, most->radius, farthest);
}

/// Returns gains, by sample and channel, that scale down samples which would send out more than they get; empty if none
/// does. A sample sends out, by the kernel's symmetry, what it would get from a surface that sends 1 everywhere. Sets
/// largest_gain and capped_area of `result`.
std::vector<float> find_gains(KernelSums& sums, const std::vector<OrderedSample>& ordered, std::size_t channels,
                              float solid_angle, const ProgressFunction& progress, Scattering& result) {
  const std::size_t count = ordered.size();
  const std::vector<float> ones(count * row_lanes, 1.f);
  sums.set_vectors(ones, 1, row_lanes, {});
  std::vector<float> sent(count * channels);
  evaluate_all(sums, count, solid_angle, progress, [&](std::size_t p, const std::vector<float>& all) {
    for (std::size_t c = 0; c < channels; ++c) sent[p * channels + c] = all[c * row_lanes];
  });
  double all_area = 0;
  std::vector<double> capped(channels, 0);
  for (std::size_t k = 0; k < count; ++k) {
    all_area += ordered[k].area;
    for (std::size_t c = 0; c < channels; ++c) capped[c] += sent[k * channels + c] > 1 ? ordered[k].area : 0;
  }
  result.capped_area = *std::max_element(capped.begin(), capped.end()) / all_area;
  result.largest_gain = *std::max_element(sent.begin(), sent.end());
  if (result.largest_gain <= 1) return {};
  std::transform(sent.begin(), sent.end(), sent.begin(), [](float all) { return all > 1 ? 1 / all : 1.f; });
  return sent;
}

/// Squares of the octree's error and of the exact transfer, summed over points and coefficients.
struct SquaredError {
  double error = 0, length = 0;
};

/// Adds the error of coefficients `first` to `first` + `width` of result.transfer, at result.error_points samples, to
/// the sums over every sample on its own. `sums` has these coefficients' vectors.
void measure_hierarchy(const KernelSums& sums, const SampleOctree& tree, int first, int width, const Scattering& result,
                       SquaredError& squared) {
  const std::size_t count = tree.order.size(), stride = padded(width);
  std::vector<double> errors(result.error_points, 0), lengths(result.error_points, 0);
  parallel_for(std::size_t{0}, result.error_points, [&](std::size_t e) {
    const std::size_t p = e * count / result.error_points;
    KernelSums::Scratch scratch(sums);
    const std::vector<float>& all = sums.evaluate(static_cast<std::uint32_t>(p), 0.f, scratch);
    for (std::size_t c = 0; c < result.transfer.size(); ++c)
      for (int i = 0; i < width; ++i) {
        const double exact = all[c * stride + static_cast<std::size_t>(i)];
        const double off = result.transfer[c].plane(first + i)[tree.order[p]] - exact;
        errors[e] += off * off;
        lengths[e] += exact * exact;
      }
  });
  for (std::size_t e = 0; e < result.error_points; ++e) {
    squared.error += errors[e];
    squared.length += lengths[e];
  }
}

/// Computes result.transfer, some coefficients at a time, and its error.
void scatter_chunks(KernelSums& sums, const SampleOctree& tree, const std::vector<TransferVectors>& incoming,
                    const std::vector<float>& gains, float solid_angle, const ProgressFunction& progress,
                    Scattering& result) {
  const int coefficients = incoming[0].coefficients;
  SquaredError squared;
  for (int first = 0; first < coefficients; first += chunk_coefficients) {
    const int width = std::min(chunk_coefficients, coefficients - first);
    const std::vector<float> rows = gather_rows(incoming, tree, first, width);
    const std::size_t stride = padded(width);
    sums.set_vectors(rows, incoming.size(), stride, gains);
    const auto put = [&](std::size_t p, const std::vector<float>& all) {
      for (std::size_t c = 0; c < result.transfer.size(); ++c)
        for (int i = 0; i < width; ++i)
          result.transfer[c].plane(first + i)[tree.order[p]] = all[c * stride + static_cast<std::size_t>(i)];
    };
    const double all = coefficients;
    evaluate_all(sums, tree.order.size(), solid_angle, part_of(progress, first / all, (first + width) / all), put);
    measure_hierarchy(sums, tree, first, width, result, squared);
  }
  result.hierarchy_error = squared.length > 0 ? std::sqrt(squared.error / squared.length) : 0;
}

/// Returns the share of energy that leaves the surface, by channel.
std::vector<double> energy_shares(const std::vector<float>& areas, const std::vector<TransferVectors>& incoming,
                                  const std::vector<TransferVectors>& outgoing) {
  std::vector<double> shares;
  for (std::size_t c = 0; c < outgoing.size(); ++c) {
    double in = 0, out = 0;
    for (std::size_t k = 0; k < areas.size(); ++k) {
      in += static_cast<double>(areas[k]) * incoming[incoming.size() == 1 ? 0 : c].plane(0)[k];
      out += static_cast<double>(areas[k]) * outgoing[c].plane(0)[k];
    }
    shares.push_back(in > 0 ? out / in : 0);
  }
  return shares;
}

}  // namespace

Scattering scatter_transfer(const SurfaceSamples& samples, const std::vector<TransferVectors>& incoming,
                            std::span<const ScatterProfile> profiles, const ScatteringSettings& settings,
                            const ProgressFunction& progress) {
  check(samples, incoming, profiles);
  constexpr double gains_share = 0.2;  // share of the progress
  const auto solid_angle = static_cast<float>(settings.solid_angle);
  const SampleOctree tree(samples);
  const std::vector<OrderedSample> ordered = ordered_samples(samples, tree);
  const KernelTables kernels = make_kernels(profiles, tree, ordered);
  KernelSums sums(tree, ordered, kernels);

  Scattering result;
  const std::vector<float> gains =
      find_gains(sums, ordered, profiles.size(), solid_angle, part_of(progress, 0, gains_share), result);
  result.transfer.assign(profiles.size(), TransferVectors(samples.size(), incoming[0].coefficients));
  result.error_points = std::min(settings.error_points, samples.size());
  scatter_chunks(sums, tree, incoming, gains, solid_angle, part_of(progress, gains_share, 1), result);
  result.energy = energy_shares(samples.areas, incoming, result.transfer);
  return result;
}

}  // namespace kiln
