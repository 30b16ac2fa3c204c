#include "image/srgb.h"

#include <algorithm>
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

}  // namespace kiln
