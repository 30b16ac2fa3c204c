// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace kiln {

/// Statistics over pairs of a receiver and a direction. pairs - behind_tiles - lit_tiles - shadowed_tiles were tested
/// one by one.
struct TransferWork {
  std::uint64_t pairs = 0;           ///< all pairs
  std::uint64_t behind_tiles = 0;    ///< skipped: the whole tile of receivers faces away (normal cone)
  std::uint64_t lit_tiles = 0;       ///< skipped: nothing stands before the whole tile
  std::uint64_t shadowed_tiles = 0;  ///< skipped: the whole tile lies behind something
  std::uint64_t single_rays = 0;     ///< pairs whose receivers are not cast as beams, but ray by ray
  std::uint64_t ambiguous = 0;       ///< depth tests within the map's error band
  std::uint64_t refined = 0;         ///< ambiguous pairs that rays decided

  TransferWork operator-(const TransferWork& earlier) const {
    return {pairs - earlier.pairs,
            behind_tiles - earlier.behind_tiles,
            lit_tiles - earlier.lit_tiles,
            shadowed_tiles - earlier.shadowed_tiles,
            single_rays - earlier.single_rays,
            ambiguous - earlier.ambiguous,
            refined - earlier.refined};
  }
};

}  // namespace kiln
