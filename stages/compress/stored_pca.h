#pragma once

#include <cstdint>
#include <vector>

#include "compress/clustered_pca.h"
#include "compress/error_spread.h"

namespace kiln {

/// For every texel of the atlas the covered texel whose cluster it has: itself where covered, one next to it in the
/// gutter, `no_owner` beyond `gutter` texels from any.
std::vector<std::uint32_t> gutter_owners(const TransferSource& source, int gutter);
inline constexpr std::uint32_t no_owner = ~0u;

/// A model, and for every texel of the atlas which of its subspaces the texel's weights are of.
struct TexelModel {
  PcaModel model;
  std::vector<std::uint8_t> ids;      ///< one per texel of the atlas
  std::vector<std::uint32_t> owners;  ///< gutter_owners
};

/// Spreads the clusters of covered texels over the gutter, and over texels beyond it, which repeat their left
/// neighbour.
TexelModel texel_model(const TransferSource& source, const ClusteredPca& clustered,
                       const std::vector<std::uint32_t>& owners);
TexelModel texel_model(const TransferSource& source, const PcaModel& one, const std::vector<std::uint32_t>& owners);

/// Values of 0 to 2^bits - 1 that stand for what `range` says.
struct StoredPicture {
  Image<std::uint16_t> values;
  int bits = 8;
  PlaneRange range;

  /// The last value that is used, so that log2(levels + 1) bits would do.
  int largest() const;
};

/// A compressed asset as it is written.
struct StoredPca {
  TexelModel decoded;                      ///< with the means and bases that a consumer gets
  Image<std::uint16_t> vectors;            ///< means and bases, weighted: pca.json's vectors_file
  std::vector<StoredPicture> vector_rows;  ///< ranges alone, of the means, then of each basis vector
  std::vector<StoredPicture> weights;
};

/// Means and bases rounded as they will be stored, for weights that are stored in steps of `step`: fine enough to add
/// little to the error of those. `variances` of the components as principal_components has them.
PcaModel rounded_model(const PcaModel& model, const TransferSource& source, const PrincipalComponents& all, double step,
                       StoredPca* stored = nullptr);

/// Turns vectors of texels, as TransferSource gives them, into the errors of those texels where weights are stored in
/// steps of `step`, fitted to the means and bases of `decoded`, which must outlive it; `step` 0: not rounded.
VectorErrors vector_errors(const TexelModel& decoded, double step);

/// The same of covered texels of `source`, which must outlive it, too.
TexelErrors stored_errors(const TransferSource& source, const TexelModel& decoded, double step);

/// Weights fitted by least squares to the rounded bases, in equal steps of `step` in all planes: of all ways to spend
/// bits on orthogonal components the one of least error (reverse water-filling; Cover and Thomas, 10.3.3). A plane
/// of more than 256 steps is stored with 16 bits.
StoredPca store_pca(const TransferSource& source, const TexelModel& model, const PrincipalComponents& all, double step);

}  // namespace kiln
