// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "asset/prt_asset.h"
#include "material/wavelength_albedo.h"
#include "spectrum/spectrum.h"

namespace kiln {

/// Returns a reflectance that an asset ships with.
Spectrum spectrum_of(const PrtReflectance& shipped);

/// Folds an asset's transfer at wavelengths into fewer channels, with what its surface reflects of them.
class WavelengthFold {
 public:
  /// The surface has the measured reflectance, or else at the planes' texels that of the asset's materials which were
  /// measured, else its albedo, lifted there, or, where that is not known, all of 1. `asset` outlives this. Throws
  /// MachineLacks.
  WavelengthFold(const PrtAsset& asset, const std::optional<Spectrum>& measured);

  /// Returns the asset with, as transfer, that of the wavelengths times what the surface reflects of them, through
  /// `channels`, a row for each channel that is made and a column for each wavelength: planes of 16 bits. The albedo is
  /// within the transfer then.
  PrtAsset through(const Eigen::MatrixXd& channels) const;

 private:
  void shares_at(std::size_t place, std::span<float> shares) const;
  std::vector<float> vectors(const Eigen::MatrixXf& channels, std::size_t places) const;

  const PrtAsset& asset_;
  WavelengthAlbedo at_wavelengths_;
  std::vector<std::vector<float>> of_materials_;  ///< of the asset's reflectances
  std::vector<float> constant_;  ///< reflectances of all of the surface; empty where its albedo is a picture
};

}  // namespace kiln
