// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/chart_bitmap.h"

#include <algorithm>
#include <cmath>

namespace kiln {

namespace {

/// Bit image, rows of 64-bit words.
class Bits {
 public:
  Bits(int width, int height)
      : words_per_row_((width + 63) / 64), height_(height), words_(std::size_t(words_per_row_) * height, 0) {}

  void set(int row, int first, int last) {
    std::uint64_t* words = row_words(row);
    for (int word = first / 64; word <= last / 64; ++word) {
      std::uint64_t mask = ~std::uint64_t{0};
      if (word == first / 64) mask &= ~std::uint64_t{0} << (first % 64);
      if (word == last / 64) mask &= ~std::uint64_t{0} >> (63 - last % 64);
      words[word] |= mask;
    }
  }

  std::uint64_t* row_words(int row) { return words_.data() + std::size_t(row) * words_per_row_; }
  const std::uint64_t* row_words(int row) const { return words_.data() + std::size_t(row) * words_per_row_; }
  int words_per_row() const { return words_per_row_; }
  int height() const { return height_; }

  /// Returns a word of this image or-ed with its eight shifted neighbours: the image grown by one texel.
  std::uint64_t grown(int row, int word) const {
    std::uint64_t result = 0;
    for (int r = std::max(0, row - 1); r <= std::min(height_ - 1, row + 1); ++r) {
      const std::uint64_t* words = row_words(r);
      const std::uint64_t before = word > 0 ? words[word - 1] >> 63 : 0;
      const std::uint64_t after = word + 1 < words_per_row_ ? words[word + 1] << 63 : 0;
      result |= words[word] | (words[word] << 1) | (words[word] >> 1) | before | after;
    }
    return result;
  }

 private:
  int words_per_row_, height_;
  std::vector<std::uint64_t> words_;
};

/// Sets, row by row, the texels whose centre lies within `across` (in the maximum norm; 1/2 is a texel's extent) of a
/// segment drawn `margin` wide to all sides, with square ends.
void fill_segment(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double margin, double across, Bits& bits,
                  int width) {
  const Eigen::Vector2d difference = b - a;
  const double length = difference.norm();
  const Eigen::Vector2d along = length > 0 ? Eigen::Vector2d(difference / length) : Eigen::Vector2d(1, 0);
  const Eigen::Vector2d middle = 0.5 * (a + b);
  // Solve |along . (c - middle)| <= half_length and |normal . (c - middle)| <= half_width, each enlarged by the texel's
  // box.
  const double spread = across * (std::abs(along.x()) + std::abs(along.y()));
  const double half_length = 0.5 * length + margin + spread, half_width = margin + spread;
  const Eigen::Vector2d reach(
      std::abs(along.x()) * 0.5 * length + margin * (std::abs(along.x()) + std::abs(along.y())) + across,
      std::abs(along.y()) * 0.5 * length + margin * (std::abs(along.x()) + std::abs(along.y())) + across);
  const int first_row = std::max(0, static_cast<int>(std::ceil(middle.y() - reach.y() - 0.5)));
  const int last_row = std::min(bits.height() - 1, static_cast<int>(std::floor(middle.y() + reach.y() - 0.5)));
  for (int row = first_row; row <= last_row; ++row) {
    const double y = row + 0.5 - middle.y();
    double low = -reach.x(), high = reach.x();
    const auto clip = [&](double slope, double constant, double half) {  // |slope * x + constant| <= half
      if (slope < 0) {
        slope = -slope;
        constant = -constant;
      }
      if (slope > 1e-12) {
        low = std::max(low, (-half - constant) / slope);
        high = std::min(high, (half - constant) / slope);
      } else if (std::abs(constant) > half) {
        high = low - 1;
      }
    };
    clip(along.x(), along.y() * y, half_length);
    clip(-along.y(), along.x() * y, half_width);
    if (low > high) continue;
    const int first = std::max(0, static_cast<int>(std::ceil(middle.x() + low - 0.5)));
    const int last = std::min(width - 1, static_cast<int>(std::floor(middle.x() + high - 0.5)));
    if (first <= last) bits.set(row, first, last);
  }
}

/// Sets the texels whose centre is inside: those with an odd number of the outline's crossings to the left in their
/// row.
void fill_inside(const ChartOutline& outline, Bits& bits, int width) {
  std::vector<std::vector<double>> crossings(bits.height());
  for (const auto& [a, b] : outline) {
    const auto [low, high] = std::minmax(a.y(), b.y());
    const int first_row = std::max(0, static_cast<int>(std::ceil(low - 0.5)));
    for (int row = first_row; row < bits.height() && row + 0.5 < high; ++row)
      crossings[row].push_back(a.x() + (row + 0.5 - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
  }
  for (int row = 0; row < bits.height(); ++row) {
    std::vector<double>& x = crossings[row];
    std::sort(x.begin(), x.end());
    for (std::size_t i = 0; i + 1 < x.size(); i += 2) {
      const int first = std::max(0, static_cast<int>(std::ceil(x[i] - 0.5)));
      const int last = std::min(width - 1, static_cast<int>(std::floor(x[i + 1] - 0.5)));
      if (first <= last) bits.set(row, first, last);
    }
  }
}

void append_runs(const Bits& bits, int row, std::vector<TexelRun>& runs) {
  const std::uint64_t* words = bits.row_words(row);
  for (int word = 0; word < bits.words_per_row(); ++word) {
    std::uint64_t left = words[word];
    while (left != 0) {
      const int first = __builtin_ctzll(left);
      const std::uint64_t clear_after = ~left & (~std::uint64_t{0} << first);
      const int last = clear_after != 0 ? __builtin_ctzll(clear_after) - 1 : 63;
      if (!runs.empty() && runs.back().last + 1 == word * 64 + first)
        runs.back().last = word * 64 + last;
      else
        runs.push_back({word * 64 + first, word * 64 + last});
      left &= last < 63 ? ~std::uint64_t{0} << (last + 1) : 0;
    }
  }
}

/// Turns and scales an outline as the settings say.
ChartOutline outline_in_texels(const ChartOutline& outline, const BitmapSettings& settings) {
  Eigen::Matrix2d turn;
  turn << std::cos(settings.angle), -std::sin(settings.angle), std::sin(settings.angle), std::cos(settings.angle);
  turn *= settings.texels_per_unit;
  ChartOutline result;
  result.reserve(outline.size());
  for (const auto& [a, b] : outline) result.emplace_back(turn * a, turn * b);
  return result;
}

/// Adds the texels that the border touches and that neither are set nor lie beside one that is.
void add_slivers(const ChartOutline& outline, double margin, int width, Bits& bits) {
  Bits touched(width, bits.height()), strays(width, bits.height());
  for (const auto& [a, b] : outline) fill_segment(a, b, margin, 0.5, touched, width);
  for (int row = 0; row < bits.height(); ++row)
    for (int word = 0; word < bits.words_per_row(); ++word)
      if (const std::uint64_t all = touched.row_words(row)[word]; all != 0)
        strays.row_words(row)[word] = all & ~bits.grown(row, word);
  for (int row = 0; row < bits.height(); ++row)
    for (int word = 0; word < bits.words_per_row(); ++word) bits.row_words(row)[word] |= strays.row_words(row)[word];
}

/// Takes the rows and columns that are not empty, and measures them.
void take_cropped(const Bits& bits, int width, ChartBitmap& bitmap) {
  bitmap.rows.resize(bits.height());
  int left = width, right = -1, bottom = bits.height(), top = -1;
  for (int row = 0; row < bits.height(); ++row) {
    append_runs(bits, row, bitmap.rows[row]);
    if (bitmap.rows[row].empty()) continue;
    left = std::min(left, bitmap.rows[row].front().first);
    right = std::max(right, bitmap.rows[row].back().last);
    bottom = std::min(bottom, row);
    top = row;
  }
  bitmap.rows.erase(bitmap.rows.begin() + top + 1, bitmap.rows.end());
  bitmap.rows.erase(bitmap.rows.begin(), bitmap.rows.begin() + bottom);
  for (int row = 0; row < static_cast<int>(bitmap.rows.size()); ++row)
    for (TexelRun& run : bitmap.rows[row]) {
      run.first -= left;
      run.last -= left;
      const int length = run.last - run.first + 1;
      bitmap.texels += length;
      bitmap.middle_row += (row + 0.5) * length;
      if (length > bitmap.widest_run) {
        bitmap.widest_run = length;
        bitmap.widest_row = row;
      }
    }
  bitmap.middle_row /= static_cast<double>(bitmap.texels);
  bitmap.width = right - left + 1;
  bitmap.height = top - bottom + 1;
  bitmap.origin += Eigen::Vector2d(left, bottom);
}

}  // namespace

Eigen::Vector2d turned(const Eigen::Vector2d& uv, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * uv.x() - s * uv.y(), s * uv.x() + c * uv.y()};
}

ChartOutline chart_outline(const Chart& chart) {
  ChartOutline outline;
  for (const auto& [from, to] : border_edges(chart)) outline.emplace_back(chart.uvs[from], chart.uvs[to]);
  return outline;
}

ChartBitmap rasterise_chart(const ChartOutline& outline, const BitmapSettings& settings) {
  ChartOutline turned_outline = outline_in_texels(outline, settings);
  Eigen::Vector2d lowest = turned_outline[0].first, highest = lowest;
  for (const auto& [a, b] : turned_outline) {
    lowest = lowest.cwiseMin(a);
    highest = highest.cwiseMax(a);
  }
  ChartBitmap bitmap;
  bitmap.angle = settings.angle;
  bitmap.origin = lowest - Eigen::Vector2d::Constant(settings.margin);
  const int width = static_cast<int>(std::ceil(highest.x() - bitmap.origin.x() + settings.margin)) + 1;
  const int height = static_cast<int>(std::ceil(highest.y() - bitmap.origin.y() + settings.margin)) + 1;
  for (auto& [a, b] : turned_outline) {
    a -= bitmap.origin;
    b -= bitmap.origin;
  }

  Bits bits(width, height);
  fill_inside(turned_outline, bits, width);
  for (const auto& [a, b] : turned_outline) fill_segment(a, b, settings.margin, 0, bits, width);
  if (settings.every_touched)
    for (const auto& [a, b] : turned_outline) fill_segment(a, b, settings.margin, 0.5, bits, width);
  else if (settings.slivers)
    add_slivers(turned_outline, settings.margin, width, bits);
  take_cropped(bits, width, bitmap);
  return bitmap;
}

}  // namespace kiln
