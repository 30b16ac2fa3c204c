#include "compress/clustered_pca.h"

#include <Eigen/SVD>
#include <algorithm>
#include <limits>
#include <random>
#include <tbb/parallel_for.h>

namespace kiln {

namespace {

constexpr std::size_t sampled_texels = 32768;
constexpr int mean_rounds = 6, subspace_rounds = 12, full_rounds = 2;
constexpr int tried_subspaces = 12;

using Ids = std::vector<std::uint8_t>;

/// Squared distances of the columns of `vectors` (or with half the squared length of the columns left out) to means.
Eigen::MatrixXf mean_distances(const Eigen::MatrixXf& vectors, const Eigen::MatrixXf& means) {
  Eigen::MatrixXf distances = -2 * means.transpose() * vectors;
  distances.colwise() += means.colwise().squaredNorm().transpose();
  return distances;  // clusters x texels, less the texel's own squared length
}

/// First means: texels far from those taken before, with probability by squared distance (k-means++; Arthur and
/// Vassilvitskii 2007). Fewer than asked for where no texel is left that differs.
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

/// Squared distance of x to a subspace with an orthonormal basis; the others are room to work in.
float subspace_distance(Eigen::Ref<const Eigen::VectorXf> x, const PcaModel& model, std::size_t cluster,
                        Eigen::VectorXf& centred, Eigen::VectorXf& weights) {
  centred = x - model.means[cluster];
  const float squared = centred.squaredNorm();
  weights.noalias() = model.bases[cluster].transpose() * centred;
  return squared - weights.squaredNorm();
}

/// Gives each column the nearest subspace among those with the nearest means and its present one; returns the sum of
/// squared distances, each at least 0.
double assign(const Eigen::MatrixXf& vectors, const PcaModel& model, std::span<std::uint8_t> ids, bool has_present) {
  Eigen::MatrixXf means(vectors.rows(), model.clusters());
  for (int c = 0; c < model.clusters(); ++c) means.col(c) = model.means[static_cast<std::size_t>(c)];
  const int tried = std::min(tried_subspaces, model.clusters());
  const Eigen::MatrixXf distances = mean_distances(vectors, means);
  std::vector<std::pair<float, int>> nearest(static_cast<std::size_t>(tried));  // nearest first; of equals the first
  Eigen::VectorXf centred(vectors.rows()), weights(model.components);
  double sum = 0;
  for (Eigen::Index k = 0; k < vectors.cols(); ++k) {
    std::size_t found = 0;
    for (int c = 0; c < model.clusters(); ++c) {
      const float distance = distances(c, k);
      if (found == nearest.size() && distance >= nearest.back().first) continue;
      std::size_t place = found < nearest.size() ? found++ : found - 1;
      for (; place > 0 && distance < nearest[place - 1].first; --place) nearest[place] = nearest[place - 1];
      nearest[place] = {distance, c};
    }
    std::uint8_t& id = ids[static_cast<std::size_t>(k)];
    float least = has_present ? subspace_distance(vectors.col(k), model, id, centred, weights)
                              : std::numeric_limits<float>::infinity();
    for (int t = 0; t < tried; ++t) {
      const auto cluster = static_cast<std::size_t>(nearest[static_cast<std::size_t>(t)].second);
      const float distance = subspace_distance(vectors.col(k), model, cluster, centred, weights);
      if (distance < least) {
        least = distance;
        id = static_cast<std::uint8_t>(cluster);
      }
    }
    sum += std::max(0.f, least);
  }
  return sum;
}

/// Principal components of every cluster's texels; a cluster without texels keeps its subspace.
void refit(const TransferSource& source, std::span<const std::uint32_t> texels, const Ids& ids, PcaModel& model) {
  std::vector<std::vector<std::uint32_t>> members(static_cast<std::size_t>(model.clusters()));
  for (std::size_t k = 0; k < texels.size(); ++k) members[ids[k]].push_back(texels[k]);
  tbb::parallel_for(std::size_t{0}, members.size(), [&](std::size_t c) {
    if (!members[c].empty()) fit_subspace(source.vectors(members[c]), model.components, model.means[c], model.bases[c]);
  });
}

double assign_all(const TransferSource& source, std::span<const std::uint32_t> texels, const PcaModel& model, Ids& ids,
                  bool has_present) {
  return sum_of_chunks(texels.size(), [&](std::size_t first, std::size_t count) {
    return assign(source.vectors(texels.subspan(first, count)), model, std::span(ids).subspan(first, count),
                  has_present);
  });
}

/// Turns bases and moves means within their subspaces (see the header).
void align(const PrincipalComponents& all, PcaModel& model) {
  const Eigen::MatrixXf axes = all.vectors.leftCols(model.components);
  for (std::size_t c = 0; c < model.means.size(); ++c) {
    Eigen::MatrixXf& basis = model.bases[c];
    const Eigen::JacobiSVD<Eigen::MatrixXf> svd(basis.transpose() * axes, Eigen::ComputeFullU | Eigen::ComputeFullV);
    basis = basis * (svd.matrixU() * svd.matrixV().transpose());  // orthogonal Procrustes (Schoenemann 1966)
    model.means[c] -= basis * (basis.transpose() * (model.means[c] - all.mean));
  }
}

}  // namespace

ClusteredPca clustered_pca(const TransferSource& source, const PrincipalComponents& all, int clusters, int components,
                           int seed) {
  // Clusters about means.
  const std::vector<std::uint32_t> sample = source.sample(sampled_texels);
  const Eigen::MatrixXf first = first_means(source.vectors(sample), clusters, seed);
  ClusteredPca result;
  PcaModel& model = result.model;
  for (Eigen::Index c = 0; c < first.cols(); ++c) {
    model.means.emplace_back(first.col(c));
    model.bases.emplace_back(source.length(), 0);
  }
  Ids ids(sample.size());
  for (int round = 0; round < mean_rounds; ++round) {
    assign_all(source, sample, model, ids, round > 0);
    refit(source, sample, ids, model);
  }

  // Subspaces, on the sample.
  model.components = components;
  refit(source, sample, ids, model);
  for (Eigen::MatrixXf& basis : model.bases)
    if (basis.cols() < components) basis = all.vectors.leftCols(components);  // of a cluster without texels
  for (int round = 0; round < subspace_rounds; ++round) {
    assign_all(source, sample, model, ids, true);
    refit(source, sample, ids, model);
  }

  // On all texels.
  result.ids.assign(source.covered().size(), 0);
  for (int round = 0; round < full_rounds; ++round) {
    assign_all(source, source.covered(), model, result.ids, round > 0);
    refit(source, source.covered(), result.ids, model);
  }
  result.residual = assign_all(source, source.covered(), model, result.ids, true);
  align(all, model);
  return result;
}

}  // namespace kiln
