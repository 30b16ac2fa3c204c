// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/channel_texture.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "base/errors.h"
#include "image/image_file.h"
#include "material/texture_lookup.h"

namespace kiln {

namespace {

using Channel = SourceShare::Channel;

constexpr float full_value(std::uint8_t) { return 255; }
constexpr float full_value(float) { return 1; }

/// Tells whether a picture has alpha, and any that is not 1.
template <class Value>
bool has_holes(const Image<Value>& pixels) {
  const int channels = pixels.channels(), alpha = channels - 1;
  if (channels != 2 && channels != 4) return false;
  for (int j = 0; j < pixels.height(); ++j)
    for (int i = 0; i < pixels.width(); ++i)
      if (static_cast<float>(pixels.at(i, j, alpha)) < full_value(Value{})) return true;
  return false;
}

/// Reads one channel of pixels whose numbers of channels differ: grey, grey and alpha, RGB, RGBA or more.
template <class Value>
class ChannelReader {
 public:
  ChannelReader(const Image<Value>& pixels, Channel channel) : pixels_(pixels), channel_(channel) {
    if (channel == Channel::coverage) channel_ = has_holes(pixels) ? Channel::alpha : Channel::grey;
  }

  float operator()(int i, int j) const {
    const int channels = pixels_.channels();
    const auto value = [&](int c) { return static_cast<float>(pixels_.at(i, j, c)) / full_value(Value{}); };
    if (channel_ == Channel::alpha) return channels == 2 ? value(1) : channels >= 4 ? value(3) : 1;
    if (channels < 3 || channel_ == Channel::red) return value(0);
    if (channel_ == Channel::green) return value(1);
    if (channel_ == Channel::blue) return value(2);
    return (value(0) + value(1) + value(2)) / 3;
  }

 private:
  const Image<Value>& pixels_;
  Channel channel_;
};

}  // namespace

ChannelTexture::ChannelTexture(const SourcePicture& source, Channel channel, float base, float gain) {
  const Picture picture =
      source.bytes != nullptr ? read_picture(*source.bytes, source.name) : read_picture(source.file);
  std::visit(
      [&]<class Value>(const Image<Value>& pixels) {
        const ChannelReader<Value> stored(pixels, channel);
        values_ = Image<std::uint16_t>(pixels.width(), pixels.height(), 1);
        for (int j = 0; j < pixels.height(); ++j)
          for (int i = 0; i < pixels.width(); ++i) {
            const float value = base + gain * stored(i, j);
            if (!std::isfinite(value))
              throw BadInput(source.name, "has a pixel that is not a finite number", "values of 0 to 1",
                             "mend the picture");
            values_.at(i, j) = static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.f, 1.f) * largest));
          }
      },
      picture.pixels);
  const auto [low, high] = std::minmax_element(values_.values().begin(), values_.values().end());
  lowest_ = static_cast<float>(*low) / largest;
  highest_ = static_cast<float>(*high) / largest;
}

float ChannelTexture::at(const Eigen::Vector2f& uv, Wrap wrap_u, Wrap wrap_v) const {
  return BilinearTexels(uv, width(), height(), wrap_u, wrap_v).interpolate([this](int i, int j) {
    return value(i, j);
  });
}

float ChannelTexture::texel(int column, int row, Wrap wrap_u, Wrap wrap_v) const {
  return value(wrapped_texel(column, width(), wrap_u), wrapped_texel(row, height(), wrap_v));
}

}  // namespace kiln
