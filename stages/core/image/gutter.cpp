// SPDX-License-Identifier: MIT
#include "image/gutter.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "base/parallel.h"

namespace kiln {

namespace {

/// Level of the pyramid: values, and which of them are known.
struct Level {
  Image<float> values;
  std::vector<std::uint8_t> known;
};

template <class Body>
void for_each_row(int height, const Body& body) {
  parallel_for(0, height, 16, [&](int j) { body(j); });
}

/// Pushes: makes every coarse texel the mean of the known ones among its (up to) four.
Level coarser(const Image<float>& fine, const std::vector<std::uint8_t>& known) {
  const int width = (fine.width() + 1) / 2, height = (fine.height() + 1) / 2;
  Level coarse{Image<float>(width, height, fine.channels()),
               std::vector<std::uint8_t>(static_cast<std::size_t>(width) * height)};
  for_each_row(height, [&](int j) {
    for (int i = 0; i < width; ++i) {
      const std::span<float> sum = coarse.values.pixel(i, j);
      int count = 0;
      for (int y = 2 * j; y < std::min(2 * j + 2, fine.height()); ++y)
        for (int x = 2 * i; x < std::min(2 * i + 2, fine.width()); ++x) {
          if (known[static_cast<std::size_t>(y) * fine.width() + x] == 0) continue;
          const std::span<const float> from = fine.pixel(x, y);
          for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += from[c];
          ++count;
        }
      if (count == 0) continue;
      for (float& value : sum) value /= static_cast<float>(count);
      coarse.known[static_cast<std::size_t>(j) * width + i] = 1;
    }
  });
  return coarse;
}

/// Pulls: interpolates unknown texels bilinearly from the coarser level, where every texel has a value by now.
void fill_from_coarser(Image<float>& fine, const std::vector<std::uint8_t>& known, const Image<float>& coarse) {
  for_each_row(fine.height(), [&](int j) {
    // The centre of an even texel lies a quarter of a coarse texel below the coarse centre, that of an odd one above.
    const int y0 = j / 2, y1 = std::clamp(j % 2 == 0 ? y0 - 1 : y0 + 1, 0, coarse.height() - 1);
    for (int i = 0; i < fine.width(); ++i) {
      if (known[static_cast<std::size_t>(j) * fine.width() + i] != 0) continue;
      const int x0 = i / 2, x1 = std::clamp(i % 2 == 0 ? x0 - 1 : x0 + 1, 0, coarse.width() - 1);
      const std::span<const float> near = coarse.pixel(x0, y0), beside = coarse.pixel(x1, y0),
                                   above = coarse.pixel(x0, y1), across = coarse.pixel(x1, y1);
      const std::span<float> to = fine.pixel(i, j);
      for (std::size_t c = 0; c < to.size(); ++c)
        to[c] = 0.5625f * near[c] + 0.1875f * beside[c] + 0.1875f * above[c] + 0.0625f * across[c];
    }
  });
}

/// Sets texels next to covered ones to the mean of their covered neighbours, without values from farther away.
void fill_ring(Image<float>& image, const std::vector<std::uint8_t>& covered) {
  const int width = image.width(), height = image.height();
  for_each_row(height, [&](int j) {
    for (int i = 0; i < width; ++i) {
      if (covered[static_cast<std::size_t>(j) * width + i] != 0) continue;
      std::array<std::pair<int, int>, 8> neighbours;
      int count = 0;
      for (int y = std::max(j - 1, 0); y <= std::min(j + 1, height - 1); ++y)
        for (int x = std::max(i - 1, 0); x <= std::min(i + 1, width - 1); ++x)
          if (covered[static_cast<std::size_t>(y) * width + x] != 0) neighbours[count++] = {x, y};
      if (count == 0) continue;
      const std::span<float> to = image.pixel(i, j);
      for (std::size_t c = 0; c < to.size(); ++c) {
        float sum = 0;
        for (int k = 0; k < count; ++k) sum += image.at(neighbours[k].first, neighbours[k].second, static_cast<int>(c));
        to[c] = sum / static_cast<float>(count);
      }
    }
  });
}

}  // namespace

void fill_gutters(Image<float>& image, const std::vector<std::uint8_t>& covered) {
  if (covered.size() != static_cast<std::size_t>(image.width()) * image.height())
    throw std::invalid_argument("fill_gutters: one coverage value per texel is needed");
  if (std::none_of(covered.begin(), covered.end(), [](std::uint8_t c) { return c != 0; })) return;

  // Push: make coarser levels until one has no holes, at the latest the single texel.
  std::vector<Level> levels;
  const auto has_holes = [](const std::vector<std::uint8_t>& known) {
    return std::find(known.begin(), known.end(), 0) != known.end();
  };
  if (!has_holes(covered)) return;
  levels.push_back(coarser(image, covered));
  while (has_holes(levels.back().known)) levels.push_back(coarser(levels.back().values, levels.back().known));

  // Pull.
  for (std::size_t k = levels.size() - 1; k > 0; --k)
    fill_from_coarser(levels[k - 1].values, levels[k - 1].known, levels[k].values);
  fill_from_coarser(image, covered, levels.front().values);

  fill_ring(image, covered);
}

}  // namespace kiln
