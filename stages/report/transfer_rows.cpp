// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/transfer_rows.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace kiln {

TransferRows in_rows(const TransferVectors& transfer) {
  TransferRows rows{static_cast<std::size_t>(transfer.coefficients), {}};
  rows.values.resize(transfer.receivers * rows.length);
  for (std::size_t i = 0; i < rows.length; ++i) {
    const std::span<const float> plane = transfer.plane(static_cast<int>(i));
    for (std::size_t r = 0; r < transfer.receivers; ++r) rows.values[r * rows.length + i] = plane[r];
  }
  return rows;
}

TransferRows in_rows(const std::vector<TransferVectors>& colors, int channels) {
  const int coefficients = colors.front().coefficients;
  TransferRows rows{static_cast<std::size_t>(coefficients) * static_cast<std::size_t>(channels), {}};
  rows.values.reserve(colors.front().receivers * rows.length);
  for (std::size_t r = 0; r < colors.front().receivers; ++r)
    for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c)
      for (int i = 0; i < coefficients; ++i)
        rows.values.push_back(channels == 1
                                  ? (colors[0].plane(i)[r] + colors[1].plane(i)[r] + colors[2].plane(i)[r]) / 3
                                  : colors[c].plane(i)[r]);
  return rows;
}

TransferRows in_channels(const TransferRows& vectors, int coefficients, int channels) {
  TransferRows result{static_cast<std::size_t>(coefficients) * static_cast<std::size_t>(channels), {}};
  for (std::size_t k = 0; k < vectors.size(); ++k)
    for (int c = 0; c < channels; ++c) {
      const std::span<const float> first = vectors.of(k).first(static_cast<std::size_t>(coefficients));
      result.values.insert(result.values.end(), first.begin(), first.end());
    }
  return result;
}

TransferRows cut_to(const TransferRows& vectors, int coefficients, int channels) {
  const auto kept = static_cast<std::size_t>(coefficients);
  const std::size_t each = vectors.length / static_cast<std::size_t>(channels);
  TransferRows result{kept * static_cast<std::size_t>(channels), {}};
  for (std::size_t k = 0; k < vectors.size(); ++k)
    for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c) {
      const std::span<const float> first = vectors.of(k).subspan(c * each, kept);
      result.values.insert(result.values.end(), first.begin(), first.end());
    }
  return result;
}

TransferRows sum_of(TransferRows a, const TransferRows& b) {
  std::ranges::transform(a.values, b.values, a.values.begin(), std::plus<>());
  return a;
}

TransferRows times(TransferRows vectors, const std::vector<PathShares>& colors, int channels) {
  const std::size_t each = vectors.length / static_cast<std::size_t>(channels);
  for (std::size_t k = 0; k < vectors.values.size(); ++k) {
    const PathShares& color = colors[k / vectors.length];
    const auto channel = static_cast<Eigen::Index>(k % vectors.length / each);
    vectors.values[k] *= channels == 1 ? color.mean() : color[channel];
  }
  return vectors;
}

TransferRows looked_up(const std::vector<Lookup>& lookups, const std::vector<std::uint32_t>& slots,
                       const TransferRows& of_slot) {
  TransferRows result{of_slot.length, std::vector<float>(lookups.size() * of_slot.length)};
  for (std::size_t s = 0; s < lookups.size(); ++s)
    for (std::size_t k = 0; k < 4; ++k) {
      const auto at = std::ranges::lower_bound(slots, lookups[s].slots[k]) - slots.begin();
      const std::span<const float> vector = of_slot.of(static_cast<std::size_t>(at));
      for (std::size_t i = 0; i < of_slot.length; ++i)
        result.values[s * of_slot.length + i] += lookups[s].weights[k] * vector[i];
    }
  return result;
}

TransferRows looked_up(const std::vector<Lookup>& lookups, const TransferRows& of_own_slots) {
  TransferRows result{of_own_slots.length, std::vector<float>(lookups.size() * of_own_slots.length)};
  for (std::size_t s = 0; s < lookups.size(); ++s)
    for (std::size_t k = 0; k < 4; ++k) {
      const std::span<const float> vector = of_own_slots.of(4 * s + k);
      for (std::size_t i = 0; i < result.length; ++i)
        result.values[s * result.length + i] += lookups[s].weights[k] * vector[i];
    }
  return result;
}

TransferRows stored_rows(const PrtAsset& asset, const std::vector<std::uint32_t>& slots) {
  TransferRows rows{asset.vector_length(), {}};
  if (asset.is_per_vertex()) {
    for (const std::uint32_t vertex : slots) {
      const auto from = asset.vertex_transfer.begin() + static_cast<std::ptrdiff_t>(vertex * rows.length);
      rows.values.insert(rows.values.end(), from, from + static_cast<std::ptrdiff_t>(rows.length));
    }
    return rows;
  }
  rows.values.resize(slots.size() * rows.length);
  decode_transfer(asset, slots, rows.values);
  return rows;
}

TransferRows rounded_to(const PrtAsset& asset, TransferRows vectors) {
  for (std::size_t k = 0; k < vectors.values.size(); ++k) {
    const PlaneRange& range = asset.planes[k % vectors.length].range;
    const double step = range.step(asset.bits);
    const double steps = std::round((double{vectors.values[k]} - range.lowest) / step);
    vectors.values[k] = static_cast<float>(step > 0 ? range.lowest + step * steps : range.lowest);
  }
  return vectors;
}

}  // namespace kiln
