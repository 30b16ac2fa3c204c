// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

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

  /// Reads all pixels as `type` into `rows`, which has room for them. Returns the fault, or nothing.
  virtual std::string read(SampleType type, void* rows) = 0;
};

/// What Kiln asks of the library that encodes and decodes pictures, so that a program loads that library with the first
/// picture: OpenImageIO brings some 260 others, half a CPU second of every start. Methods report faults as text, since
/// they know no file's role.
class PictureCodec {
 public:
  virtual ~PictureCodec() = default;

  /// Writes a PNG ("png", not premultiplied) or a losslessly compressed OpenEXR ("openexr"; more than four channels are
  /// named so that OpenEXR keeps their order). Returns the fault, or nothing.
  virtual std::string write(const std::string& file, const char* format, const PictureShape& shape, SampleType type,
                            const void* rows) = 0;

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
