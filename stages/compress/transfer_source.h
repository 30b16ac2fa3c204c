#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "asset/prt_asset.h"

namespace kiln {

/// An asset's transfer vectors, weighted by the square root of lighting_prior so that the squared length of a
/// difference is its expected relighting error (design: E). They are decoded from the planes as
/// they are asked for, those of small atlases once.
class TransferSource {
 public:
  /// Texels are covered where the asset's mesh covers them; `asset` must outlive this. Throws BadInput where none is.
  explicit TransferSource(const PrtAsset& asset);

  /// The same with coverage given: nonzero where covered, one per texel, rows from the bottom.
  TransferSource(const PrtAsset& asset, std::vector<std::uint8_t> coverage);

  const PrtAsset& asset() const { return asset_; }
  int length() const { return static_cast<int>(scale_.size()); }  ///< of a vector: channels * bands^2
  const Eigen::VectorXf& scale() const { return scale_; }         ///< what the entries are weighted with
  const std::vector<std::uint8_t>& coverage() const { return coverage_; }
  const std::vector<std::uint32_t>& covered() const { return covered_; }  ///< texels, ascending
  double squared_norm() const { return squared_norm_; }                   ///< of all covered vectors

  /// Up to `most` covered texels, evenly spread.
  std::vector<std::uint32_t> sample(std::size_t most) const;

  /// length() x texels.size().
  Eigen::MatrixXf vectors(std::span<const std::uint32_t> texels) const;

 private:
  Eigen::MatrixXf decoded(std::span<const std::uint32_t> texels) const;
  void remember();

  const PrtAsset& asset_;
  Eigen::VectorXf scale_;
  std::vector<std::uint8_t> coverage_;
  std::vector<std::uint32_t> covered_;
  Eigen::MatrixXf known_;              ///< vectors of all covered texels; empty where they would take much memory
  std::vector<std::uint32_t> places_;  ///< of an atlas' texels, columns of known_
  double squared_norm_ = 0;
};

/// Runs `body(first, count)` for chunks of a range of `size`, in parallel; the chunks do not depend on the number of
/// threads, so sums per chunk that are added up in their order do not either.
void for_each_chunk(std::size_t size, const std::function<void(std::size_t first, std::size_t count)>& body);
inline constexpr std::size_t chunk_texels = 4096;

/// The sum over chunks, in their order, of what `body(first, count)` gives.
double sum_of_chunks(std::size_t size, const std::function<double(std::size_t first, std::size_t count)>& body);

}  // namespace kiln
