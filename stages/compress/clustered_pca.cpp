// SPDX-License-Identifier: GPL-3.0-or-later
#include "compress/clustered_pca.h"

#include <Eigen/SVD>
#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <tuple>

#include "base/parallel.h"
#include "compress/chunks.h"

namespace kiln {

namespace {

constexpr std::size_t training_texels = 32768;
constexpr int mean_rounds = 6, subspace_rounds = 10, full_rounds = 1, further_rounds = 8;
constexpr int tried_subspaces = 16;

using Ids = std::vector<std::uint8_t>;

/// Returns squared distances of the columns of `vectors` to means, clusters x texels, minus the columns' own squared
/// lengths.
Eigen::MatrixXf mean_distances(const Eigen::MatrixXf& vectors, const Eigen::MatrixXf& means) {
  Eigen::MatrixXf distances = -2 * means.transpose() * vectors;
  distances.colwise() += means.colwise().squaredNorm().transpose();
  return distances;
}

/// Chooses first means: texels far from those chosen before, with probability by squared distance (k-means++ [Arthur
/// 2007]). Fewer than asked for where no different texel is left.
Eigen::MatrixXf first_means(const Eigen::MatrixXf& vectors, int clusters, int seed) {
  std::mt19937 random(static_cast<std::uint32_t>(seed));
  const auto uniform = [&] { return (static_cast<double>(random()) + 0.5) / 4294967296.0; };
  const auto size = static_cast<std::size_t>(vectors.cols());
  std::vector<Eigen::Index> chosen = {static_cast<Eigen::Index>(uniform() * static_cast<double>(size))};
  std::vector<double> nearest(size, std::numeric_limits<double>::infinity());
  const double least = 1e-12 * vectors.cast<double>().squaredNorm() / static_cast<double>(size);
  while (static_cast<int>(chosen.size()) < clusters) {
    double total = 0;
    for (std::size_t k = 0; k < size; ++k) {
      const double distance =
          (vectors.col(static_cast<Eigen::Index>(k)) - vectors.col(chosen.back())).cast<double>().squaredNorm();
      nearest[k] = std::min(nearest[k], distance);
      total += nearest[k];
    }
    if (total <= least) break;
    double left = uniform() * total;
    std::size_t k = 0;
    while (k + 1 < size && left >= nearest[k]) left -= nearest[k++];
    chosen.push_back(static_cast<Eigen::Index>(k));
  }
  Eigen::MatrixXf means(vectors.rows(), static_cast<Eigen::Index>(chosen.size()));
  for (std::size_t c = 0; c < chosen.size(); ++c) means.col(static_cast<Eigen::Index>(c)) = vectors.col(chosen[c]);
  return means;
}

/// Assigns each column to the nearest mean, the first among equals.
void assign_to_means(const Eigen::MatrixXf& vectors, const Eigen::MatrixXf& means, std::span<std::uint8_t> ids) {
  const Eigen::MatrixXf distances = mean_distances(vectors, means);
  for (Eigen::Index k = 0; k < vectors.cols(); ++k) {
    Eigen::Index nearest = 0;
    distances.col(k).minCoeff(&nearest);
    ids[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(nearest);
  }
}

/// Lists, for each cluster, the indices of its texels in a list of texels.
std::vector<std::vector<std::uint32_t>> members_of(const Ids& ids, int clusters) {
  std::vector<std::vector<std::uint32_t>> members(static_cast<std::size_t>(clusters));
  for (std::size_t k = 0; k < ids.size(); ++k) members[ids[k]].push_back(static_cast<std::uint32_t>(k));
  return members;
}

/// Callback that returns the vectors at indices of a list of texels.
using VectorsOf = std::function<Eigen::MatrixXf(std::span<const std::uint32_t> places)>;

VectorsOf vectors_of(const TransferSource& source, std::span<const std::uint32_t> texels) {
  return [&source, texels](std::span<const std::uint32_t> places) {
    std::vector<std::uint32_t> some(places.size());
    std::transform(places.begin(), places.end(), some.begin(), [&](std::uint32_t place) { return texels[place]; });
    return source.vectors(some);
  };
}

VectorsOf vectors_of(const Eigen::MatrixXf& vectors) {
  return [&vectors](std::span<const std::uint32_t> places) {
    Eigen::MatrixXf some(vectors.rows(), static_cast<Eigen::Index>(places.size()));
    for (std::size_t k = 0; k < places.size(); ++k) some.col(static_cast<Eigen::Index>(k)) = vectors.col(places[k]);
    return some;
  };
}

/// Subspaces that texels near one mean try, as one matrix: the basis vectors of each, and the difference of its mean
/// from that mean.
struct Tried {
  std::vector<std::uint8_t> clusters;
  Eigen::MatrixXf axes;        ///< length x tried * (components + 1)
  Eigen::VectorXf own_weight;  ///< per subspace: axes times the difference of means

  Tried(const PcaModel& model, const Eigen::MatrixXf& means, std::size_t nearest_mean) {
    const auto count = std::min<std::size_t>(tried_subspaces, model.means.size());
    const Eigen::VectorXf distances = (means.colwise() - model.means[nearest_mean]).colwise().squaredNorm();
    std::vector<std::uint8_t> order(model.means.size());
    std::iota(order.begin(), order.end(), std::uint8_t{0});
    std::partial_sort(
        order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(),
        [&](std::uint8_t a, std::uint8_t b) { return std::pair(distances[a], a) < std::pair(distances[b], b); });
    clusters.assign(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count));
    const int width = model.components + 1;
    axes.resize(means.rows(), static_cast<Eigen::Index>(count) * width);
    own_weight.resize(axes.cols());
    for (std::size_t t = 0; t < count; ++t) {
      const Eigen::VectorXf shift = model.means[clusters[t]] - model.means[nearest_mean];
      auto part = axes.middleCols(static_cast<Eigen::Index>(t) * width, width);
      part << model.bases[clusters[t]], shift;
      own_weight.segment(static_cast<Eigen::Index>(t) * width, width) = part.transpose() * shift;
    }
  }
};

/// Returns the squared distance of x to a subspace with an orthonormal basis.
float subspace_distance(const Eigen::VectorXf& x, const PcaModel& model, std::size_t cluster) {
  const Eigen::VectorXf centred = x - model.means[cluster];
  return centred.squaredNorm() - (model.bases[cluster].transpose() * centred).squaredNorm();
}

/// Clusters of the texels of a list, and the mean nearest to each, which decides what subspaces it tries.
struct Assignment {
  Ids ids, near;
};

/// Assigns texels of one nearest mean to the nearest among the subspaces they try and their present one, and updates
/// their nearest mean. `vectors` are relative to that mean. Returns the sum of squared distances, each at least 0.
double assign_group(const Eigen::MatrixXf& vectors, const Eigen::VectorXf& mean, const Tried& tried,
                    const PcaModel& model, std::span<const std::uint32_t> places, Assignment& assignment) {
  const int components = model.components;
  const Eigen::MatrixXf products = tried.axes.transpose() * vectors;
  const Eigen::RowVectorXf lengths = vectors.colwise().squaredNorm();
  double sum = 0;
  for (Eigen::Index k = 0; k < vectors.cols(); ++k) {
    const float* product = products.col(k).data();
    const float* own = tried.own_weight.data();
    float least = std::numeric_limits<float>::infinity(), least_to_mean = least;
    std::uint8_t& id = assignment.ids[places[static_cast<std::size_t>(k)]];
    std::uint8_t nearest = id, near = 0;
    bool has_present = false;
    for (const std::uint8_t cluster : tried.clusters) {
      // Squared distance: |x - shift|^2 minus the squared weights of x - shift.
      float distance = lengths[k] - 2 * product[components] + own[components];
      if (distance < least_to_mean) {
        least_to_mean = distance;
        near = cluster;
      }
      for (int j = 0; j < components; ++j) distance -= (product[j] - own[j]) * (product[j] - own[j]);
      if (distance < least) {
        least = distance;
        nearest = cluster;
      }
      has_present |= cluster == id;
      product += components + 1;
      own += components + 1;
    }
    if (!has_present)
      if (const float distance = subspace_distance(vectors.col(k) + mean, model, id); distance < least) {
        least = distance;
        nearest = id;
      }
    id = nearest;
    assignment.near[places[static_cast<std::size_t>(k)]] = near;
    sum += std::max(0.f, least);
  }
  return sum;
}

/// Assigns every texel to the nearest among its present subspace and those whose means are around the mean nearest to
/// it; returns the sum of squared distances. The nearest mean is updated among the same candidates, so it follows means
/// that move.
double assign(const VectorsOf& vectors, const PcaModel& model, Assignment& assignment) {
  constexpr std::size_t most_members = 4096;  // number of members whose vectors are in memory at once
  Eigen::MatrixXf means(model.means.front().size(), model.clusters());
  for (int c = 0; c < model.clusters(); ++c) means.col(c) = model.means[static_cast<std::size_t>(c)];
  const auto members = members_of(assignment.near, model.clusters());
  std::vector<double> sums(members.size(), 0.0);
  parallel_for(std::size_t{0}, members.size(), [&](std::size_t c) {
    if (members[c].empty()) return;
    const Tried tried(model, means, c);
    for (std::size_t first = 0; first < members[c].size(); first += most_members) {
      const auto places = std::span(members[c]).subspan(first, std::min(most_members, members[c].size() - first));
      const Eigen::MatrixXf centred = vectors(places).colwise() - model.means[c];
      sums[c] += assign_group(centred, model.means[c], tried, model, places, assignment);
    }
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

/// Finds the nearest mean of every texel among all means.
void find_near(const VectorsOf& vectors, const PcaModel& model, Ids& near) {
  Eigen::MatrixXf means(model.means.front().size(), model.clusters());
  for (int c = 0; c < model.clusters(); ++c) means.col(c) = model.means[static_cast<std::size_t>(c)];
  for_each_chunk(near.size(), [&](std::size_t first, std::size_t count) {
    std::vector<std::uint32_t> places(count);
    std::iota(places.begin(), places.end(), static_cast<std::uint32_t>(first));
    assign_to_means(vectors(places), means, std::span(near).subspan(first, count));
  });
}

/// Computes principal components of every cluster's texels; a cluster without texels keeps its subspace.
void refit(const VectorsOf& vectors, const Ids& ids, PcaModel& model) {
  const auto members = members_of(ids, model.clusters());
  parallel_for(std::size_t{0}, members.size(), [&](std::size_t c) {
    if (!members[c].empty()) fit_subspace(vectors(members[c]), model.components, model.means[c], model.bases[c]);
  });
}

/// Moves every mean to that of its texels; a cluster without texels keeps its own.
void move_means(const Eigen::MatrixXf& vectors, const Ids& ids, Eigen::MatrixXf& means) {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(means.rows(), means.cols());
  std::vector<std::size_t> counts(static_cast<std::size_t>(means.cols()), 0);
  for (std::size_t k = 0; k < ids.size(); ++k) {
    sums.col(ids[k]) += vectors.col(static_cast<Eigen::Index>(k)).cast<double>();
    ++counts[ids[k]];
  }
  for (Eigen::Index c = 0; c < means.cols(); ++c)
    if (const std::size_t count = counts[static_cast<std::size_t>(c)]; count > 0)
      means.col(c) = (sums.col(c) / static_cast<double>(count)).cast<float>();
}

/// Rotates bases and moves means within their subspaces (see clustered_pca in the header).
void align(const PrincipalComponents& all, PcaModel& model) {
  const Eigen::MatrixXf axes = all.vectors.leftCols(model.components);
  for (std::size_t c = 0; c < model.means.size(); ++c) {
    Eigen::MatrixXf& basis = model.bases[c];
    const Eigen::JacobiSVD<Eigen::MatrixXf> svd(basis.transpose() * axes, Eigen::ComputeFullU | Eigen::ComputeFullV);
    basis = basis * (svd.matrixU() * svd.matrixV().transpose());  // orthogonal Procrustes [Schoenemann 1966]
    model.means[c] -= basis * (basis.transpose() * (model.means[c] - all.mean));
  }
}

/// Runs rounds on all texels, and measures the residual.
void settle(const TransferSource& source, const PrincipalComponents& all, int rounds, Assignment& every,
            ClusteredPca& result) {
  const VectorsOf covered = vectors_of(source, source.covered());
  for (int round = 0; round < rounds; ++round) {
    assign(covered, result.model, every);
    refit(covered, every.ids, result.model);
  }
  result.residual = assign(covered, result.model, every);
  result.ids = every.ids;
  align(all, result.model);
}

}  // namespace

TexelClusters cluster_texels(const TransferSource& source, int clusters, int seed) {
  TexelClusters result;
  result.sample = source.sample(training_texels);
  result.vectors = source.vectors(result.sample);
  result.means = first_means(result.vectors, clusters, seed);
  result.ids.resize(result.sample.size());
  for (int round = 0; round < mean_rounds; ++round) {
    for_each_chunk(result.ids.size(), [&](std::size_t first, std::size_t count) {
      assign_to_means(result.vectors.middleCols(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(count)),
                      result.means, std::span(result.ids).subspan(first, count));
    });
    move_means(result.vectors, result.ids, result.means);
  }
  return result;
}

ClusteredPca clustered_pca(const TransferSource& source, const PrincipalComponents& all, const TexelClusters& start,
                           int components) {
  ClusteredPca result;
  PcaModel& model = result.model;
  model.components = components;
  for (Eigen::Index c = 0; c < start.means.cols(); ++c) {
    model.means.emplace_back(start.means.col(c));
    model.bases.emplace_back(all.vectors.leftCols(components));  // kept by a cluster without texels
  }

  // Step 1: fit subspaces to the sample.
  const VectorsOf sampled = vectors_of(start.vectors);
  Assignment some{start.ids, start.ids};
  refit(sampled, some.ids, model);
  for (int round = 0; round < subspace_rounds; ++round) {
    assign(sampled, model, some);
    refit(sampled, some.ids, model);
  }

  // Step 2: fit them to all texels.
  const std::size_t count = source.covered().size();
  Assignment every{Ids(count), Ids(count)};
  find_near(vectors_of(source, source.covered()), model, every.near);
  every.ids = every.near;
  settle(source, all, full_rounds, every, result);
  return result;
}

void improve(const TransferSource& source, const PrincipalComponents& all, ClusteredPca& clustered) {
  const VectorsOf covered = vectors_of(source, source.covered());
  refit(covered, clustered.ids, clustered.model);  // aligned means are no longer near their texels
  Assignment every{clustered.ids, Ids(clustered.ids.size())};
  find_near(covered, clustered.model, every.near);
  settle(source, all, further_rounds, every, clustered);
}

ClusteredPca clustered_pca(const TransferSource& source, const PrincipalComponents& all, int clusters, int components,
                           int seed) {
  return clustered_pca(source, all, cluster_texels(source, clusters, seed), components);
}

}  // namespace kiln
