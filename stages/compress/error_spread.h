// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "compress/transfer_source.h"

namespace kiln {

/// Spread of an error over covered texels. All values are lengths of vectors weighted as TransferSource weights them,
/// relative to the root mean square length of the covered texels' vectors.
struct ErrorSpread {
  double mean = 0;    ///< root mean square: the expected relighting error
  double texel = 0;   ///< bound that 999 of 1,000 texels stay under
  double border = 0;  ///< bound that 999 of 1,000 jumps stay under: a jump is the difference of the errors of two
                      ///< texels that are neighbours along a row or a column and of different clusters
};

/// Callback that returns the weighted errors of covered texels: length x texels.
using TexelErrors = std::function<Eigen::MatrixXf(std::span<const std::uint32_t> texels)>;

/// Measures all covered texels. `ids` are the clusters of the atlas's texels; empty: there is one. Texels are requested
/// strip after strip of rows, so that memory does not grow with the atlas; the same for any number of threads.
ErrorSpread error_spread(const TransferSource& source, const TexelErrors& errors, std::span<const std::uint8_t> ids);

/// Measures some covered texels, without borders.
ErrorSpread error_spread(const TransferSource& source, const TexelErrors& errors,
                         std::span<const std::uint32_t> texels);

/// Callback that turns weighted vectors of texels into their errors, in place.
using VectorErrors = std::function<void(Eigen::Ref<Eigen::MatrixXf> vectors, std::span<const std::uint32_t> texels)>;

/// Measures some covered texels whose vectors are known, without borders.
ErrorSpread error_spread(const TransferSource& source, const VectorErrors& errors, const Eigen::MatrixXf& vectors,
                         std::span<const std::uint32_t> texels);

/// Measures how a decoded asset differs from `source` over the latter's covered texels; both have the same size, bands
/// and channels.
ErrorSpread spread_of_decoded(const PrtAsset& decoded, const TransferSource& source);

}  // namespace kiln
