// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include "atlas/chart_bitmap.h"
#include "atlas/texel_grid.h"

namespace kiln {

/// Index of free runs of texels in the rows of a grid. For some lengths it keeps one bit per texel: whether that many
/// texels from it on are free. Any run is covered by a few runs of such lengths, so one step decides it for 256 places
/// at once.
class FreeRuns {
 public:
  /// `longest` is the longest run that will be asked for.
  FreeRuns(int width, int height, int longest);

  /// Updates these rows from a grid of that size; returns the number of words it passed over.
  std::int64_t update(const TexelGrid& grid, int first_row, int last_row);

  static constexpr int span = 256;
  static constexpr int span_words = span / 64;
  /// One bit per place, from the lowest on, in a vector of the compiler's for whatever registers the machine has.
  using Mask __attribute__((vector_size(span / 8))) = std::uint64_t;

  /// Part of a chart's run that one step decides.
  struct Probe {
    std::size_t words = 0;  ///< offset of the words of its row and length, with the chart at row 0
    int first = 0;          ///< first column of such a length
    int second = 0;
  };

  /// Appends the probes that decide a run in a row of a chart.
  void append_probes(int row, const TexelRun& run, std::vector<Probe>& probes) const;

  /// Clears in `mask`, whose first place is `start`, the places x at which the run is not free with its chart moved to
  /// column x and row y.
  void keep_free(const Probe& probe, int y, int start, Mask& mask) const {
    const std::uint64_t* words =
        words_.data() + static_cast<std::size_t>(y) * (row_words_ * lengths_.size()) + probe.words;
    and_shifted(words, start + probe.first, mask);
    and_shifted(words, start + probe.second, mask);
  }

 private:
  static void and_shifted(const std::uint64_t* words, int bit, Mask& mask) {
    Mask here, next;
    std::memcpy(&here, words + bit / 64, sizeof here);
    std::memcpy(&next, words + bit / 64 + 1, sizeof next);
    const int shift = bit % 64;
    mask &= here >> shift | next << 1 << (63 - shift);
  }

  void find_levels(std::uint64_t* words) const;

  int width_, grid_words_;
  std::vector<int> lengths_;  ///< powers of two
  std::size_t row_words_;     ///< words per row of one length, with zeros behind for runs that reach across
  std::vector<std::uint64_t> words_;
};

}  // namespace kiln
