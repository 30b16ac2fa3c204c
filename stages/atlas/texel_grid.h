// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

namespace kiln {

/// Occupied texels of an atlas, a bit each.
class TexelGrid {
 public:
  TexelGrid(int width, int height) : width_(width), height_(height), words_per_row_((width + 63) / 64) {
    words_.assign(static_cast<std::size_t>(words_per_row_) * height, 0);
    longest_free_.assign(height, width);
  }

  int width() const { return width_; }
  int height() const { return height_; }

  /// Occupies columns `first` to `last` of a row, as far as they lie inside.
  void take(int row, int first, int last);

  /// Returns the longest run of free columns in a row.
  int longest_free(int row) const {
    if (longest_free_[row] < 0) longest_free_[row] = find_longest_free(row);
    return longest_free_[row];
  }

  /// Returns the row's bits, 64 columns a word.
  const std::uint64_t* row_words(int row) const {
    return words_.data() + static_cast<std::size_t>(row) * words_per_row_;
  }

 private:
  int find_longest_free(int row) const;

  int width_, height_, words_per_row_;
  std::vector<std::uint64_t> words_;
  mutable std::vector<int> longest_free_;  ///< per row; -1: not known
};

inline void TexelGrid::take(int row, int first, int last) {
  if (row < 0 || row >= height_) return;
  if (first < 0) first = 0;
  if (last >= width_) last = width_ - 1;
  longest_free_[row] = -1;
  std::uint64_t* words = words_.data() + static_cast<std::size_t>(row) * words_per_row_;
  for (int word = first / 64; first <= last && word <= last / 64; ++word) {
    std::uint64_t mask = ~std::uint64_t{0};
    if (word == first / 64) mask &= ~std::uint64_t{0} << (first % 64);
    if (word == last / 64) mask &= ~std::uint64_t{0} >> (63 - last % 64);
    words[word] |= mask;
  }
}

inline int TexelGrid::find_longest_free(int row) const {
  const std::uint64_t* words = words_.data() + static_cast<std::size_t>(row) * words_per_row_;
  int longest = 0, start = 0;  // free columns before the one looked at
  for (int word = 0; word < words_per_row_; ++word) {
    std::uint64_t bits = words[word];
    while (bits != 0) {
      const int taken = word * 64 + __builtin_ctzll(bits);
      if (taken - start > longest) longest = taken - start;
      const std::uint64_t after = ~bits >> (taken % 64);  // skips the occupied columns that follow
      const int length = after != 0 ? __builtin_ctzll(after) : 64 - taken % 64;
      start = taken + length;
      const int next = start - word * 64;
      bits &= next < 64 ? ~std::uint64_t{0} << next : 0;
    }
  }
  return width_ - start > longest ? width_ - start : longest;
}

}  // namespace kiln
