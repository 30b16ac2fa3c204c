// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "image/image.h"

namespace kiln {

/// Writes a PNG of 1 (grey), 3 (RGB) or 4 (RGBA, not premultiplied) channels; not interlaced, no time stamp: the same
/// pixels give the same bytes. Throws BadInput where the file cannot be written.
void write_png(const std::filesystem::path& file, const Image<std::uint8_t>& image);
void write_png(const std::filesystem::path& file, const Image<std::uint16_t>& image);

/// Writes a 32-bit float OpenEXR of any number of channels, losslessly compressed.
void write_exr(const std::filesystem::path& file, const Image<float>& image);

/// Reads a PNG of 8 or 16 bits per channel without converting values. Throws BadInput where it is not a whole PNG or
/// has another depth.
Image<std::uint8_t> read_png8(const std::filesystem::path& file);
Image<std::uint16_t> read_png16(const std::filesystem::path& file);

/// Reads a PNG of 8 or 16 bits per channel as 16: 255 becomes 65,535. Sets `bits`, if given, to those of the file.
/// Throws BadInput where it is not a whole PNG of either.
Image<std::uint16_t> read_png_as16(const std::filesystem::path& file, int* bits = nullptr);

/// Reads EXR or HDR (Radiance) as floats. Throws BadInput.
Image<float> read_float_image(const std::filesystem::path& file);

/// Picture as its file has it.
struct Picture {
  std::variant<Image<std::uint8_t>, Image<float>> pixels;  ///< bytes of 0 to 255; floats as in the file
  bool is_float = false;  ///< the file has floating-point values; 16-bit integers become floats of 0 to 1
};

/// Reads a PNG, JPEG, EXR, HDR or any other format that OpenImageIO reads, without converting values: grey, grey and
/// alpha, RGB, RGBA, or more channels. The format is told by the first bytes, not by the name. Throws BadInput.
Picture read_picture(const std::filesystem::path& file);

/// Reads such a picture from memory; `name` appears in messages.
Picture read_picture(const std::vector<std::uint8_t>& bytes, const std::string& name);

/// Returns red, green and blue of a picture: grey becomes three equal channels, alpha is dropped.
Picture colors_of(Picture picture);

}  // namespace kiln
