// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "image/picture_input.h"

namespace kiln {

/// What Kiln asks of OpenImageIO: pictures of formats other than PNG and OpenEXR, and lines of text. It stands in a
/// library that a program loads when it first needs one of them: OpenImageIO brings some 260 others, half a CPU second
/// of every start. Methods report faults as text, since they know no file's role.
class PictureCodec {
 public:
  virtual ~PictureCodec() = default;

  /// Opens a picture file of any format; null, with a `fault`, where it is none.
  virtual std::unique_ptr<PictureInput> open(const std::string& file, std::string& fault) = 0;

  /// Opens a picture in memory, `bytes`, which outlive the result. `format` is OpenImageIO's name of its format.
  virtual std::unique_ptr<PictureInput> open(const std::string& bytes, const std::string& format,
                                             std::string& fault) = 0;

  /// Returns the width in pixels of a line of text; 0 where nothing is drawn.
  virtual int text_width(const std::string& text, int size, const char* font) = 0;

  /// Draws a line of text, its baseline `above` rows under the top, as shares of ink, 0 to 1, top row first. Returns
  /// the fault, or nothing.
  virtual std::string draw_text(const std::string& text, int size, const char* font, int above, int width, int height,
                                std::vector<float>& ink) = 0;
};

/// Loads `libkiln-openimageio.so`, which stands in a folder that the program or the runtime library names (RUNPATH), on
/// the first call. Throws MachineLacks without it.
PictureCodec& picture_codec();

}  // namespace kiln
