#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "compress/transfer_source.h"

namespace kiln {

/// How an error is spread over covered texels. All are lengths of vectors weighted as TransferSource has them, over the
/// root mean square length of the covered texels' vectors.
struct ErrorSpread {
  double mean = 0;    ///< root mean square: the expected relighting error E
  double texel = 0;   ///< which 999 of 1,000 texels stay under
  double border = 0;  ///< which 999 of 1,000 jumps stay under: differences of the errors of two texels that are
                      ///< neighbours along a row or a column and of different clusters
};

/// The errors of covered texels, weighted: length x texels.
using TexelErrors = std::function<Eigen::MatrixXf(std::span<const std::uint32_t> texels)>;

/// Over all covered texels, `ids` being the clusters of the atlas' texels; empty: all are of one. Texels are asked for
/// strip after strip of rows, so that memory does not grow with the atlas; the same for any number of threads.
ErrorSpread error_spread(const TransferSource& source, const TexelErrors& errors, std::span<const std::uint8_t> ids);

/// Over some covered texels, without borders.
ErrorSpread error_spread(const TransferSource& source, const TexelErrors& errors,
                         std::span<const std::uint32_t> texels);

/// Turns vectors of texels, weighted, into their errors, in place.
using VectorErrors = std::function<void(Eigen::Ref<Eigen::MatrixXf> vectors, std::span<const std::uint32_t> texels)>;

/// Over some covered texels whose vectors are known, without borders.
ErrorSpread error_spread(const TransferSource& source, const VectorErrors& errors, const Eigen::MatrixXf& vectors,
                         std::span<const std::uint32_t> texels);

/// How a decoded asset differs from `source` over the covered texels of that; same size, bands and channels.
ErrorSpread spread_of_decoded(const PrtAsset& decoded, const TransferSource& source);

}  // namespace kiln
