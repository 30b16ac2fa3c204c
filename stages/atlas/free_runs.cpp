// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/free_runs.h"

#include <algorithm>

namespace kiln {

FreeRuns::FreeRuns(int width, int height, int longest) : width_(width), grid_words_((width + 63) / 64) {
  constexpr int wide = 4096;  // where memory costs more than a step or two
  const int doublings = width <= wide ? 1 : 2;
  for (int length = 1; length <= std::clamp(longest, 1, width); length <<= doublings) lengths_.push_back(length);
  // A span may begin at the last word, and its last bits are in one word more.
  row_words_ = static_cast<std::size_t>(grid_words_ + FreeRuns::span_words);
  words_.assign(row_words_ * lengths_.size() * static_cast<std::size_t>(height), 0);
}

void FreeRuns::append_probes(int row, const TexelRun& run, std::vector<Probe>& probes) const {
  std::size_t level = lengths_.size() - 1;
  while (lengths_[level] > run.last - run.first + 1) --level;
  const int length = lengths_[level], last = run.last - length + 1;
  for (int first = run.first; first <= last; first += 2 * length)
    probes.push_back({(static_cast<std::size_t>(row) * lengths_.size() + level) * row_words_, first,
                      std::min(first + length, last)});
}

std::int64_t FreeRuns::update(const TexelGrid& grid, int first_row, int last_row) {
  std::int64_t word_steps = 0;
  for (int row = std::max(0, first_row); row <= std::min(last_row, grid.height() - 1); ++row) {
    std::uint64_t* words = words_.data() + static_cast<std::size_t>(row) * lengths_.size() * row_words_;
    const std::uint64_t* taken = grid.row_words(row);
    bool same = true;
    for (int word = 0; word < grid_words_; ++word) {
      std::uint64_t free = ~taken[word];
      if (word + 1 == grid_words_ && width_ % 64 != 0) free &= ~std::uint64_t{0} >> (64 - width_ % 64);
      same = same && words[word] == free;
      words[word] = free;
    }
    word_steps += grid_words_;
    if (same) continue;
    find_levels(words);
    word_steps += static_cast<std::int64_t>(lengths_.size()) * grid_words_;
  }
  return word_steps;
}

/// Computes the longer lengths: a run of twice the length is free where two runs, one behind the other, are. Nothing
/// past the grid is free.
void FreeRuns::find_levels(std::uint64_t* words) const {
  for (std::size_t level = 1; level < lengths_.size(); ++level, words += row_words_) {
    std::uint64_t* next = words + row_words_;
    std::copy_n(words, grid_words_, next);
    for (int length = lengths_[level - 1]; length < lengths_[level]; length *= 2) {
      const int across = length / 64, shift = length % 64;
      for (int i = 0; i < grid_words_; ++i) {
        const std::uint64_t low = i + across < grid_words_ ? next[i + across] : 0;
        const std::uint64_t high = i + across + 1 < grid_words_ ? next[i + across + 1] : 0;
        next[i] &= low >> shift | high << 1 << (63 - shift);
      }
    }
  }
}

}  // namespace kiln
