// SPDX-License-Identifier: MIT
#include "image/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace kiln {

float srgb_from_linear(float linear) {
  const float x = std::clamp(linear, 0.f, 1.f);
  return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
}

float linear_from_srgb(float srgb) {
  const float x = std::clamp(srgb, 0.f, 1.f);
  return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

std::uint8_t byte_from_unit(float value) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.f, 1.f)));
}

Image<std::uint8_t> srgb_bytes(const Image<float>& linear) {
  Image<std::uint8_t> bytes(linear.width(), linear.height(), linear.channels());
  std::transform(linear.values().begin(), linear.values().end(), bytes.values().begin(),
                 [](float value) { return byte_from_unit(srgb_from_linear(value)); });
  return bytes;
}

Image<float> linear_from_srgb_bytes(const Image<std::uint8_t>& bytes) {
  std::array<float, 256> table;
  for (std::size_t byte = 0; byte < table.size(); ++byte)
    table[byte] = linear_from_srgb(static_cast<float>(byte) / 255);
  Image<float> linear(bytes.width(), bytes.height(), bytes.channels());
  std::transform(bytes.values().begin(), bytes.values().end(), linear.values().begin(),
                 [&](std::uint8_t byte) { return table[byte]; });
  return linear;
}

}  // namespace kiln
