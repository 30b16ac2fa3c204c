#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "image/image.h"

namespace kiln {

/// Linear RGBA radiance, premultiplied, as an sRGB picture with alpha; values beyond 0 to 1 are clamped.
Image<std::uint8_t> shown_radiance(const Image<float>& radiance);

/// `gain` times (a - b), averaged over the colours, where both are wholly covered: white for none, red where `a` is
/// brighter, blue where it is darker, full colour at 1. Grey where only one of them is covered, transparent elsewhere.
Image<std::uint8_t> shown_difference(const Image<float>& a, const Image<float>& b, double gain);

/// A PNG of 8 or 16 bits as 8 bits, at most `longest` pixels a side (averaged over areas).
Image<std::uint8_t> thumbnail(const std::filesystem::path& png, int bits, int longest);

/// RFC 4648, with padding.
std::string base64(std::string_view bytes);

/// The picture as the value of an `src` attribute: a PNG, written to `scratch` on its way.
std::string data_uri(const Image<std::uint8_t>& image, const std::filesystem::path& scratch);

}  // namespace kiln
