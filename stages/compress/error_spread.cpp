// SPDX-License-Identifier: GPL-3.0-or-later
#include "compress/error_spread.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "compress/chunks.h"

namespace kiln {

namespace {

constexpr int strip_rows = 16;

/// Returns the value that 999 of 1,000 do not exceed; 0 for no values.
double nearly_largest(std::vector<float>& values) {
  if (values.empty()) return 0;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(values.size() - 1 - values.size() / 1000);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// Squared lengths of errors and of jumps.
struct Lengths {
  std::vector<float> texels, borders;

  void add(const Lengths& other) {
    texels.insert(texels.end(), other.texels.begin(), other.texels.end());
    borders.insert(borders.end(), other.borders.begin(), other.borders.end());
  }
};

ErrorSpread spread_of(Lengths& lengths, const TransferSource& source) {
  if (!(source.squared_norm() > 0)) return {};
  const double unit = std::sqrt(source.squared_norm() / static_cast<double>(source.covered().size()));
  double sum = 0;
  for (const float squared : lengths.texels) sum += squared;
  return {std::sqrt(sum / static_cast<double>(lengths.texels.size())) / unit,
          std::sqrt(nearly_largest(lengths.texels)) / unit, std::sqrt(nearly_largest(lengths.borders)) / unit};
}

/// Collects the errors of covered texels in rows `first` to `last` - 1, and of their jumps to the right and upwards.
Lengths lengths_of_rows(const TransferSource& source, const TexelErrors& errors, std::span<const std::uint8_t> ids,
                        int first, int last) {
  const auto width = static_cast<std::uint32_t>(source.asset().width);
  const std::vector<std::uint32_t>& covered = source.covered();
  const auto from = [&](int row) {
    return std::lower_bound(covered.begin(), covered.end(), static_cast<std::uint32_t>(row) * width);
  };
  const auto begin = from(first), end = from(last);
  // Read one more row, for the jumps out of the last.
  const std::span<const std::uint32_t> texels(begin, ids.empty() ? end : from(last + 1));
  Lengths lengths;
  if (begin == end) return lengths;
  const Eigen::MatrixXf values = errors(texels);
  const auto own = static_cast<Eigen::Index>(end - begin);
  for (Eigen::Index k = 0; k < own; ++k) lengths.texels.push_back(values.col(k).squaredNorm());
  if (ids.empty()) return lengths;
  std::size_t above = 0;
  for (Eigen::Index k = 0; k < own; ++k) {
    const std::uint32_t texel = texels[static_cast<std::size_t>(k)];
    const auto jump = [&](std::size_t other) {
      if (ids[texels[other]] != ids[texel])
        lengths.borders.push_back((values.col(static_cast<Eigen::Index>(other)) - values.col(k)).squaredNorm());
    };
    const auto right = static_cast<std::size_t>(k) + 1;
    if (right < texels.size() && texels[right] == texel + 1 && texels[right] % width != 0) jump(right);
    while (above < texels.size() && texels[above] < texel + width) ++above;
    if (above < texels.size() && texels[above] == texel + width) jump(above);
  }
  return lengths;
}

}  // namespace

ErrorSpread error_spread(const TransferSource& source, const TexelErrors& errors, std::span<const std::uint8_t> ids) {
  const int height = source.asset().height, strips = (height + strip_rows - 1) / strip_rows;
  std::vector<Lengths> parts(static_cast<std::size_t>(strips));
  parallel_for(0, strips, [&](int strip) {
    parts[static_cast<std::size_t>(strip)] =
        lengths_of_rows(source, errors, ids, strip * strip_rows, std::min(height, (strip + 1) * strip_rows));
  });
  Lengths all;
  for (const Lengths& part : parts) all.add(part);
  return spread_of(all, source);
}

ErrorSpread error_spread(const TransferSource& source, const TexelErrors& errors,
                         std::span<const std::uint32_t> texels) {
  Lengths all;
  all.texels.resize(texels.size());
  for_each_chunk(texels.size(), [&](std::size_t first, std::size_t count) {
    const Eigen::MatrixXf values = errors(texels.subspan(first, count));
    for (std::size_t k = 0; k < count; ++k)
      all.texels[first + k] = values.col(static_cast<Eigen::Index>(k)).squaredNorm();
  });
  return spread_of(all, source);
}

ErrorSpread error_spread(const TransferSource& source, const VectorErrors& errors, const Eigen::MatrixXf& vectors,
                         std::span<const std::uint32_t> texels) {
  Lengths all;
  all.texels.resize(texels.size());
  for_each_chunk(texels.size(), [&](std::size_t first, std::size_t count) {
    Eigen::MatrixXf values = vectors.middleCols(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(count));
    errors(values, texels.subspan(first, count));
    for (std::size_t k = 0; k < count; ++k)
      all.texels[first + k] = values.col(static_cast<Eigen::Index>(k)).squaredNorm();
  });
  return spread_of(all, source);
}

ErrorSpread spread_of_decoded(const PrtAsset& decoded, const TransferSource& source) {
  const TransferSource other(decoded, source.coverage());
  std::span<const std::uint8_t> ids;
  if (decoded.clusters && decoded.clusters->count > 1) ids = decoded.clusters->ids.values();
  return error_spread(
      source,
      [&](std::span<const std::uint32_t> texels) -> Eigen::MatrixXf {
        return other.vectors(texels) - source.vectors(texels);
      },
      ids);
}

}  // namespace kiln
