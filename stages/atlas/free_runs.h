#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include "atlas/chart_bitmap.h"
#include "atlas/texel_grid.h"

namespace kiln {

/// Where in the rows of a grid a run of texels is free: for some lengths, a bit per texel that says whether so many
/// from it on are free. Any run is covered by a few of such a length, so that one step tells it for 256 places at once.
class FreeRuns {
 public:
  /// `longest`: the longest run that will be asked for.
  FreeRuns(int width, int height, int longest);

  /// Takes over what a grid of that size has taken in these rows; returns over how many words it went.
  std::int64_t update(const TexelGrid& grid, int first_row, int last_row);

  static constexpr int span = 256;
  static constexpr int span_words = span / 64;
  /// A bit per place, from the lowest on. A vector of the compiler's, for what registers the machine has.
  using Mask __attribute__((vector_size(span / 8))) = std::uint64_t;

  /// A part of a chart's run that is told in one step.
  struct Probe {
    std::size_t words = 0;  ///< those of its row and length, where the chart lies at row 0
    int first = 0;          ///< columns at which such lengths begin
    int second = 0;
  };

  /// What tells of a run in a row of a chart.
  void append_probes(int row, const TexelRun& run, std::vector<Probe>& probes) const;

  /// Leaves only those places x of the mask, the first being `start`, at which the run is free with its chart moved to
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
  std::size_t row_words_;     ///< of one length, with zeros behind, for what reaches across
  std::vector<std::uint64_t> words_;
};

}  // namespace kiln
