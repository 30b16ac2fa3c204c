// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "image/image.h"

namespace kiln {

/// Effort spent on finding the smallest file.
enum class PngEffort {
  quick,     ///< one filter and run lengths only: some percent larger than `thorough`
  thorough,  ///< the smallest of all filters and two strategies of zlib; pictures above 1 MiB are judged on a part
};

/// Encodes a grey PNG of 8 or 16 bits (with 8, values are at most 255) as the bytes of a file; the same values give the
/// same bytes. image/image_file.h writes without filters, which costs smooth planes a tenth to a fifth of their bytes.
std::string encode_grey_png(const Image<std::uint16_t>& image, int bits, PngEffort effort);

}  // namespace kiln
