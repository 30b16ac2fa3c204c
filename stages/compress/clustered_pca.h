// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "compress/pca.h"

namespace kiln {

/// Clusters of texels, each with a subspace near them ([Sloan 2003], section 4).
struct ClusteredPca {
  PcaModel model;
  std::vector<std::uint8_t> ids;  ///< cluster of every covered texel, in the order of TransferSource::covered()
  double residual = 0;            ///< squared distance to the subspaces, summed over covered texels
};

/// Sample of the texels in clusters about means, from which models of any number of components start.
struct TexelClusters {
  std::vector<std::uint32_t> sample;  ///< covered texels
  Eigen::MatrixXf vectors;            ///< vectors of the sample
  Eigen::MatrixXf means;              ///< one column per cluster
  std::vector<std::uint8_t> ids;      ///< clusters of the sample
};

/// Clusters a sample of texels by k-means. `clusters` is 2 to 256; fewer result where there are fewer distinct texels.
TexelClusters cluster_texels(const TransferSource& source, int clusters, int seed);

/// Fits subspaces to clusters: assigns every texel to its nearest subspace and computes principal components of every
/// cluster, in turn ("iterative PCA" in [Sloan 2003]), first on the sample, then on all texels. A texel tries its
/// present subspace and those around the mean nearest to it. Bases are rotated within their subspaces to align with the
/// components of `all`, and means are moved within them to lie near the mean of `all`, so that weights hardly jump
/// where clusters meet, and compress as images.
ClusteredPca clustered_pca(const TransferSource& source, const PrincipalComponents& all, const TexelClusters& start,
                           int components);

/// Continues for further rounds on all texels, which lower the residual by some percent.
void improve(const TransferSource& source, const PrincipalComponents& all, ClusteredPca& clustered);

/// Clusters the texels and fits the subspaces.
ClusteredPca clustered_pca(const TransferSource& source, const PrincipalComponents& all, int clusters, int components,
                           int seed);

}  // namespace kiln
