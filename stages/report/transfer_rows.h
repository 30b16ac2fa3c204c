// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "asset/prt_asset.h"
#include "report/error_samples.h"
#include "report/path_albedo.h"
#include "sh/transfer.h"

namespace kiln {

/// Transfer vectors of points, one after another; each holds all channels' coefficients, channel after channel.
struct TransferRows {
  std::size_t length = 0;  ///< numbers of a vector
  std::vector<float> values;

  std::size_t size() const { return length == 0 ? 0 : values.size() / length; }
  std::span<const float> of(std::size_t k) const { return {values.data() + k * length, length}; }
};

/// Returns vectors of one channel.
TransferRows in_rows(const TransferVectors& transfer);

/// Returns vectors of red, green and blue, or of wavelengths, as an asset has them: a single channel stands for all
/// colours.
TransferRows in_rows(const std::vector<TransferVectors>& colors, int channels);

/// Returns the first coefficients of vectors of one channel, once for every channel.
TransferRows in_channels(const TransferRows& vectors, int coefficients, int channels);

/// Returns the first coefficients of each of the vectors' channels.
TransferRows cut_to(const TransferRows& vectors, int coefficients, int channels);

TransferRows sum_of(TransferRows a, const TransferRows& b);

/// Multiplies each channel of vectors by that of a colour of their own; a single channel by the mean of three.
TransferRows times(TransferRows vectors, const std::vector<PathShares>& colors, int channels);

/// Looks up vectors at all points of the samples. `of_slot` are vectors of `slots`, which are sorted.
TransferRows looked_up(const std::vector<Lookup>& lookups, const std::vector<std::uint32_t>& slots,
                       const TransferRows& of_slot);

/// Looks up vectors of which each point has four of its own, one for each slot of its lookup.
TransferRows looked_up(const std::vector<Lookup>& lookups, const TransferRows& of_own_slots);

/// Decodes the vectors that an asset stores at slots: texels, or vertices of an asset baked per vertex.
TransferRows stored_rows(const PrtAsset& asset, const std::vector<std::uint32_t>& slots);

/// Rounds vectors as the planes of an asset store them.
TransferRows rounded_to(const PrtAsset& asset, TransferRows vectors);

/// Two estimates of the same vectors, alike where there is no noise in them.
struct Station {
  TransferRows first, second;

  explicit Station(const TransferRows& both) : first(both), second(both) {}
  Station(TransferRows one, TransferRows other) : first(std::move(one)), second(std::move(other)) {}

  Station operator+(const Station& other) const { return {sum_of(first, other.first), sum_of(second, other.second)}; }

  /// Applies a function of vectors to both.
  template <class Function>
  Station through(const Function& function) const {
    return {function(first), function(second)};
  }
};

}  // namespace kiln
