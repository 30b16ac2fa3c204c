// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "compress/clustered_pca.h"
#include "compress/error_spread.h"

namespace kiln {

/// Returns, for every texel of the atlas, the covered texel whose cluster it shares: itself where covered, one next to
/// it in the gutter, and `no_owner` farther than `gutter` texels from any.
std::vector<std::uint32_t> gutter_owners(const TransferSource& source, int gutter);
inline constexpr std::uint32_t no_owner = ~0u;

/// Model, and for every texel of the atlas the number of the subspace that its weights refer to.
struct TexelModel {
  PcaModel model;
  std::vector<std::uint8_t> ids;      ///< one per texel of the atlas
  std::vector<std::uint32_t> owners;  ///< gutter_owners
};

/// Extends the clusters of covered texels over the gutter; texels beyond repeat their left neighbour.
TexelModel texel_model(const TransferSource& source, const ClusteredPca& clustered,
                       const std::vector<std::uint32_t>& owners);
TexelModel texel_model(const TransferSource& source, const PcaModel& one, const std::vector<std::uint32_t>& owners);

/// Picture of values 0 to 2^bits - 1, which `range` maps to numbers.
struct StoredPicture {
  Image<std::uint16_t> values;
  int bits = 8;
  PlaneRange range;

  /// Returns the largest value used, so that log2(levels + 1) bits would suffice.
  int largest() const;
};

/// Compressed asset as it is written.
struct StoredPca {
  TexelModel decoded;                      ///< with the means and bases that a consumer decodes
  Image<std::uint16_t> vectors;            ///< means and bases, weighted: pca.json's vectors_file
  std::vector<StoredPicture> vector_rows;  ///< only the ranges: of the means, then of each basis vector
  std::vector<StoredPicture> weights;
};

/// Rounds means and bases as they will be stored, for weights stored in steps of `step`: finely enough to add little to
/// the weights' own error. `variances` of the components are those of principal_components.
PcaModel rounded_model(const PcaModel& model, const TransferSource& source, const PrincipalComponents& all, double step,
                       StoredPca* stored = nullptr);

/// Returns a function that turns vectors of texels, as TransferSource gives them, into those texels' errors, where
/// weights are stored in steps of `step` and fitted to the means and bases of `decoded`, which must outlive it. `step`
/// 0: weights are not rounded.
VectorErrors vector_errors(const TexelModel& decoded, double step);

/// Returns the same errors for covered texels of `source`, which must outlive the function, too.
TexelErrors stored_errors(const TransferSource& source, const TexelModel& decoded, double step);

/// Fits weights by least squares to the rounded bases, in equal steps of `step` in all planes: of all ways to
/// distribute bits over orthogonal components this has the least error (reverse water-filling; [Cover 2006], section
/// 10.3.3). A plane of more than 256 steps is stored with 16 bits.
StoredPca store_pca(const TransferSource& source, const TexelModel& model, const PrincipalComponents& all, double step);

}  // namespace kiln
