#pragma once

#include <cstdint>
#include <vector>

namespace kiln {

/// The texels of an atlas that are taken, a bit each.
class TexelGrid {
 public:
  TexelGrid(int width, int height) : width_(width), height_(height), words_per_row_((width + 63) / 64) {
    words_.assign(static_cast<std::size_t>(words_per_row_) * height, 0);
  }

  int width() const { return width_; }
  int height() const { return height_; }

  /// Takes columns `first` to `last` of a row; what lies outside is left out.
  void take(int row, int first, int last);

  /// The last taken column from `first` to `last`, both inside the grid; -1 if none is.
  int last_taken(int row, int first, int last) const {
    const std::uint64_t* words = words_.data() + static_cast<std::size_t>(row) * words_per_row_;
    const int first_word = first / 64, last_word = last / 64;
    for (int word = last_word; word >= first_word; --word) {
      std::uint64_t bits = words[word];
      if (word == last_word) bits &= ~std::uint64_t{0} >> (63 - last % 64);
      if (word == first_word) bits &= ~std::uint64_t{0} << (first % 64);
      if (bits != 0) return word * 64 + 63 - __builtin_clzll(bits);
    }
    return -1;
  }

 private:
  int width_, height_, words_per_row_;
  std::vector<std::uint64_t> words_;
};

inline void TexelGrid::take(int row, int first, int last) {
  if (row < 0 || row >= height_) return;
  if (first < 0) first = 0;
  if (last >= width_) last = width_ - 1;
  std::uint64_t* words = words_.data() + static_cast<std::size_t>(row) * words_per_row_;
  for (int word = first / 64; first <= last && word <= last / 64; ++word) {
    std::uint64_t mask = ~std::uint64_t{0};
    if (word == first / 64) mask &= ~std::uint64_t{0} << (first % 64);
    if (word == last / 64) mask &= ~std::uint64_t{0} >> (63 - last % 64);
    words[word] |= mask;
  }
}

}  // namespace kiln
