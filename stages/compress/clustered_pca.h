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

/// Clusters by k-means, then in turn the nearest subspace for every texel and principal components for every cluster
/// ("iterative PCA" of the paper), first on a sample of the texels, then on all. A texel tries the subspaces with the
/// nearest means alone, besides its own. `clusters` is 2 to 256; fewer come back where there are fewer distinct
/// texels. Bases are turned within their subspaces to lie along the components of `all`, and means are moved within
/// them to lie next to the mean of `all`: weights then hardly jump where clusters meet, and compress as images.
ClusteredPca clustered_pca(const TransferSource& source, const PrincipalComponents& all, int clusters, int components,
                           int seed);

}  // namespace kiln
