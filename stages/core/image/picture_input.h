// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace kiln {

/// How a channel of a pixel is stored.
enum class SampleType { uint8, uint16, float32 };

/// Shape of a picture whose channels are interleaved; `rows` point at the BOTTOM row (image/image.h), files start with
/// the top one.
struct PictureShape {
  int width = 0;
  int height = 0;
  int channels = 0;
};

/// Picture file that has been opened, its pixels not yet read.
class PictureInput {
 public:
  virtual ~PictureInput() = default;

  virtual PictureShape shape() const = 0;
  virtual bool is_uint8() const = 0;
  virtual bool is_floating_point() const = 0;

  /// Reads all pixels as `type` into `rows`, which has room for them; integers become floats of 0 to 1. Returns the
  /// fault, or nothing.
  virtual std::string read(SampleType type, void* rows) = 0;
};

}  // namespace kiln
