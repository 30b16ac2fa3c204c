// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "image/picture_input.h"

namespace kiln {

/// Writes 32-bit floats of any number of channels as an OpenEXR picture, losslessly compressed (zip): Y, RGB or RGBA,
/// otherwise channels c00000, c00001 and so on, so that their order stays. The same pixels give the same bytes. Returns
/// the fault, or nothing.
std::string write_exr_file(const std::string& file, const PictureShape& shape, const float* rows);

/// Opens an OpenEXR picture in memory, `bytes`, which outlive the result: the first part of the file, its data window,
/// floats or integers of any width. Channels R, G, B and A come first, in this order, the others by name. Returns null,
/// with a `fault`, where it is none, is deep, or has channels of fewer pixels than others.
std::unique_ptr<PictureInput> open_exr(const std::string& bytes, std::string& fault);

}  // namespace kiln
