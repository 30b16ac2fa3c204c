// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/files.h"
#include "image/image_file.h"
#include "image/srgb.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

using Color = std::array<float, 3>;

constexpr Color white = {247, 247, 247};
constexpr Color red = {178, 24, 43};
constexpr Color blue = {33, 102, 172};
constexpr std::uint8_t uncompared_grey = 128;

/// Weights of old pixels in the new ones, along one axis.
struct AxisWeight {
  int from;
  float weight;
};
std::vector<std::vector<AxisWeight>> area_weights(int old_size, int new_size) {
  std::vector<std::vector<AxisWeight>> weights(new_size);
  const double step = static_cast<double>(old_size) / new_size;
  for (int k = 0; k < new_size; ++k)
    for (int from = static_cast<int>(k * step); from < old_size && from < (k + 1) * step; ++from) {
      const double overlap = std::min(from + 1.0, (k + 1) * step) - std::max<double>(from, k * step);
      if (overlap > 0) weights[k].push_back({from, static_cast<float>(overlap / step)});
    }
  return weights;
}

template <class Stored>
Image<std::uint8_t> shrunk(const Image<Stored>& image, int longest) {
  const double scale = std::min(1.0, static_cast<double>(longest) / std::max(image.width(), image.height()));
  const int width = std::max(1, static_cast<int>(std::lround(image.width() * scale)));
  const int height = std::max(1, static_cast<int>(std::lround(image.height() * scale)));
  const auto columns = area_weights(image.width(), width), rows = area_weights(image.height(), height);
  constexpr float top = std::numeric_limits<Stored>::max();
  Image<std::uint8_t> result(width, height, image.channels());
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i)
      for (int c = 0; c < image.channels(); ++c) {
        float sum = 0;
        for (const AxisWeight& row : rows[j])
          for (const AxisWeight& column : columns[i])
            sum += row.weight * column.weight * static_cast<float>(image.at(column.from, row.from, c));
        result.at(i, j, c) = byte_from_unit(sum / top);
      }
  return result;
}

}  // namespace

bool is_wholly_covered(float coverage) { return coverage > 0.9999f; }

Image<std::uint8_t> shown_radiance(const Image<float>& radiance) {
  Image<std::uint8_t> shown(radiance.width(), radiance.height(), 4);
  for (int j = 0; j < radiance.height(); ++j)
    for (int i = 0; i < radiance.width(); ++i) {
      const float coverage = radiance.at(i, j, 3);
      if (coverage <= 0) continue;
      for (int c = 0; c < 3; ++c) shown.at(i, j, c) = byte_from_unit(srgb_from_linear(radiance.at(i, j, c) / coverage));
      shown.at(i, j, 3) = byte_from_unit(coverage);
    }
  return shown;
}

Image<std::uint8_t> shown_difference(const Image<float>& a, const Image<float>& b, double gain) {
  Image<std::uint8_t> shown(a.width(), a.height(), 4);
  for (int j = 0; j < a.height(); ++j)
    for (int i = 0; i < a.width(); ++i) {
      const std::span<std::uint8_t> pixel = shown.pixel(i, j);
      const float a_coverage = a.at(i, j, 3), b_coverage = b.at(i, j, 3);
      if (a_coverage <= 0 && b_coverage <= 0) continue;
      if (!is_wholly_covered(a_coverage) || !is_wholly_covered(b_coverage)) {
        std::fill_n(pixel.begin(), 3, uncompared_grey);
        pixel[3] = byte_from_unit(std::max(a_coverage, b_coverage));
        continue;
      }
      float difference = 0;
      for (int c = 0; c < 3; ++c) difference += (a.at(i, j, c) - b.at(i, j, c)) / 3;
      const float strength = std::clamp(static_cast<float>(gain) * difference, -1.f, 1.f);
      const Color& end = strength > 0 ? red : blue;
      for (int c = 0; c < 3; ++c)
        pixel[c] = byte_from_unit((white[c] + std::abs(strength) * (end[c] - white[c])) / 255);
      pixel[3] = 255;
    }
  return shown;
}

Image<std::uint8_t> thumbnail(const fs::path& png, int bits, int longest) {
  return bits == 8 ? shrunk(read_png8(png), longest) : shrunk(read_png16(png), longest);
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - k);
    std::uint32_t group = 0;
    for (std::size_t b = 0; b < 3; ++b)
      group = group << 8 | (b < count ? static_cast<unsigned char>(bytes[k + b]) : 0u);
    for (std::size_t digit = 0; digit < 4; ++digit)
      text += digit <= count ? letters[group >> (18 - 6 * digit) & 63] : '=';
  }
  return text;
}

std::string data_uri(const Image<std::uint8_t>& image, const fs::path& scratch) {
  write_png(scratch, image);
  return "data:image/png;base64," + base64(read_text(scratch));
}

}  // namespace kiln
