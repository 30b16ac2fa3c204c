#pragma once

#include <cstdint>
#include <vector>

#include "compress/pca.h"

namespace kiln {

/// Texels in clusters, each near a subspace of its own (Sloan, Hall, Hart and Snyder, "Clustered principal components
/// for precomputed radiance transfer", SIGGRAPH 2003, section 4).
struct ClusteredPca {
  PcaModel model;
  std::vector<std::uint8_t> ids;  ///< of every covered texel, in the order of TransferSource::covered()
  double residual = 0;            ///< squared length that the subspaces leave, summed over covered texels
};

/// A sample of the texels about means: what clusters of any number of components start from.
struct TexelClusters {
  std::vector<std::uint32_t> sample;  ///< covered texels
  Eigen::MatrixXf vectors;            ///< of the sample
  Eigen::MatrixXf means;              ///< a column for each cluster
  std::vector<std::uint8_t> ids;      ///< of the sample
};

/// Clusters by k-means. `clusters` is 2 to 256; fewer come back where there are fewer distinct texels.
TexelClusters cluster_texels(const TransferSource& source, int clusters, int seed);

/// From clusters about means, in turn the nearest subspace for every texel and principal components for every cluster
/// ("iterative PCA" of the paper), first on the sample, then on all texels. A texel tries the subspaces around the mean
/// next to it, and its present one. Bases are turned within their subspaces to lie along the components of `all`,
/// and means are moved within them to lie next to the mean of `all`: weights then hardly jump where clusters meet, and
/// compress as images.
ClusteredPca clustered_pca(const TransferSource& source, const PrincipalComponents& all, const TexelClusters& start,
                           int components);

/// Goes on for further rounds on all texels, which lower the residual by some percent.
void improve(const TransferSource& source, const PrincipalComponents& all, ClusteredPca& clustered);

/// Clusters the texels and fits the subspaces.
ClusteredPca clustered_pca(const TransferSource& source, const PrincipalComponents& all, int clusters, int components,
                           int seed);

}  // namespace kiln
