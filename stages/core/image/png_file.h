// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "image/picture_input.h"

namespace kiln {

/// Encodes rows of 8 or 16 bits as a PNG of 1 (grey), 3 (RGB) or 4 (RGBA, not premultiplied) channels, by libpng: not
/// interlaced, no chunks but IHDR, IDAT and IEND. The same pixels give the same bytes.
std::string encode_png(const PictureShape& shape, SampleType type, const void* rows);

/// PNG that has been opened.
class PngInput : public PictureInput {
 public:
  /// Returns the bits of a channel, or of an index of the palette, in the file: 1, 2, 4, 8 or 16.
  virtual int stored_bits() const = 0;
  virtual bool has_palette() const = 0;
};

/// Opens a PNG of any form in memory, `bytes`, which outlive the result: palettes become colours, fewer bits than 8
/// become 8, transparent colours become alpha; no value is converted otherwise, whatever gamma the file states. Returns
/// null, with a `fault` that names what was found, where it is none.
std::unique_ptr<PngInput> open_png(const std::string& bytes, std::string& fault);

}  // namespace kiln
