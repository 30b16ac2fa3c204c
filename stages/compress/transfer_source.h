// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "asset/prt_asset.h"

namespace kiln {

/// Transfer vectors of an asset, weighted by the square root of lighting_prior, so that the squared length of a
/// difference is its squared expected relighting error (ARCHITECTURE.md, "Contracts", up to the normalisation). They
/// are decoded from the planes on request; those of small atlases only once.
class TransferSource {
 public:
  /// Takes as covered the texels that the asset's mesh covers; `asset` must outlive this. Throws BadInput where there
  /// is none.
  explicit TransferSource(const PrtAsset& asset);

  /// Takes coverage as given: nonzero where covered, one entry per texel, rows from the bottom.
  TransferSource(const PrtAsset& asset, std::vector<std::uint8_t> coverage);

  const PrtAsset& asset() const { return asset_; }
  int length() const { return static_cast<int>(scale_.size()); }  ///< length of a vector: channels * bands^2
  const Eigen::VectorXf& scale() const { return scale_; }         ///< weights of the entries
  const std::vector<std::uint8_t>& coverage() const { return coverage_; }
  const std::vector<std::uint32_t>& covered() const { return covered_; }  ///< texels, ascending
  double squared_norm() const { return squared_norm_; }                   ///< summed over all covered vectors

  /// Returns up to `most` covered texels, evenly spread.
  std::vector<std::uint32_t> sample(std::size_t most) const;

  /// Returns the vectors of texels: length() x texels.size().
  Eigen::MatrixXf vectors(std::span<const std::uint32_t> texels) const;

 private:
  Eigen::MatrixXf decoded(std::span<const std::uint32_t> texels) const;
  void remember();

  const PrtAsset& asset_;
  Eigen::VectorXf scale_;
  std::vector<std::uint8_t> coverage_;
  std::vector<std::uint32_t> covered_;
  Eigen::MatrixXf known_;              ///< vectors of all covered texels; empty where they would take much memory
  std::vector<std::uint32_t> places_;  ///< column in known_ of each texel of the atlas
  double squared_norm_ = 0;
};

}  // namespace kiln
