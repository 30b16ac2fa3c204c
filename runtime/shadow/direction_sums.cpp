// SPDX-License-Identifier: MIT
#include "runtime/shadow/direction_sums.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace kiln {

namespace {

constexpr std::size_t lanes = 16, few = 8, many = 32;  ///< numbers added at once; directions that have a sum

/// Packs eight directions, each 0 or 1, so that they are compared at once.
std::uint64_t packed(const std::uint8_t* directions) {
  std::uint64_t word;
  std::memcpy(&word, directions, sizeof(word));
  return word;
}

}  // namespace

DirectionSums::DirectionSums(std::span<const float> rows, std::size_t width)
    : width_(width), stride_((width + lanes - 1) / lanes * lanes), count_(width == 0 ? 0 : rows.size() / width) {
  const std::size_t sums_of_few = count_ / few, sums_of_many = count_ / many;
  table_.assign((count_ + sums_of_few + sums_of_many) * stride_, 0.f);
  for (std::size_t d = 0; d < count_; ++d) std::copy_n(&rows[d * width], width, &table_[d * stride_]);
  const auto add = [&](std::size_t row, std::size_t first, std::size_t last) {
    for (std::size_t i = 0; i < width; ++i) {
      double sum = 0;
      for (std::size_t d = first; d < last; ++d) sum += static_cast<double>(rows[d * width + i]);
      table_[row * stride_ + i] = static_cast<float>(sum);
    }
  };
  for (std::size_t k = 0; k < sums_of_few; ++k) add(count_ + k, few * k, few * (k + 1));
  for (std::size_t k = 0; k < sums_of_many; ++k) add(count_ + sums_of_few + k, many * k, many * (k + 1));
}

void DirectionSums::add_up(std::span<const std::uint8_t> directions, std::span<float> sum) const {
  constexpr std::uint64_t all = 0x0101010101010101;
  thread_local std::vector<std::uint32_t> taken;
  taken.clear();
  const auto add = [&](std::size_t row) { taken.push_back(static_cast<std::uint32_t>(row)); };
  const std::size_t sums_of_few = count_ / few;
  for (std::size_t first = 0; first < count_; first += few) {
    if (first + few > count_) {
      for (std::size_t d = first; d < count_; ++d)
        if (directions[d] != 0) add(d);
      break;
    }
    if (first % many == 0 && first + many <= count_ && packed(&directions[first]) == all &&
        packed(&directions[first + few]) == all && packed(&directions[first + 2 * few]) == all &&
        packed(&directions[first + 3 * few]) == all) {
      add(count_ + sums_of_few + first / many);
      first += many - few;
      continue;
    }
    const std::uint64_t word = packed(&directions[first]);
    if (word == all) {
      add(count_ + first / few);
    } else if (word != 0) {
      for (std::size_t d = first; d < first + few; ++d)
        if (directions[d] != 0) add(d);
    }
  }
  for (std::size_t column = 0; column < width_; column += lanes) {
    std::array<float, lanes> part{};
    for (const std::uint32_t row : taken) {
      const float* values = &table_[row * stride_ + column];
      for (std::size_t i = 0; i < lanes; ++i) part[i] += values[i];
    }
    std::copy_n(part.data(), std::min(lanes, width_ - column), &sum[column]);
  }
}

}  // namespace kiln
