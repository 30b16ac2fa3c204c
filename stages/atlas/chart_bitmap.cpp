#include "atlas/chart_bitmap.h"

#include <algorithm>
#include <cmath>

namespace kiln {

namespace {

/// A plain bit image, rows of 64-bit words.
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

  /// Bits of a word of this image and its eight neighbours' positions, or-ed: the image grown by one texel.
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

/// Sets, row by row, the texels whose centre c satisfies e(c) >= -slack for the three edges of the triangle, slack
/// being `along * length + across * (|dx| + |dy|)` of the edge; 1/2 across is a texel's extent.
void fill_triangle(const std::array<Eigen::Vector2d, 3>& p, double along, double across, Bits& bits, int width) {
  const double reach = along + across;
  const auto [lowest_y, highest_y] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
  const auto [lowest_x, highest_x] = std::minmax({p[0].x(), p[1].x(), p[2].x()});
  const int first_row = std::max(0, static_cast<int>(std::ceil(lowest_y - 0.5 - reach)));
  const int last_row = std::min(bits.height() - 1, static_cast<int>(std::floor(highest_y - 0.5 + reach)));
  for (int row = first_row; row <= last_row; ++row) {
    const double y = row + 0.5;
    double low = lowest_x - reach, high = highest_x + reach;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector2d &a = p[k], &b = p[(k + 1) % 3];
      const double dx = b.x() - a.x(), dy = b.y() - a.y();
      const double slack = along * std::hypot(dx, dy) + across * (std::abs(dx) + std::abs(dy));
      // dx (y - a.y) - dy (x - a.x) >= -slack, solved for x
      const double constant = dx * (y - a.y()) + slack;
      if (dy > 0)
        high = std::min(high, a.x() + constant / dy);
      else if (dy < 0)
        low = std::max(low, a.x() + constant / dy);
      else if (constant < 0)
        high = low - 1;
    }
    const int first = std::max(0, static_cast<int>(std::ceil(std::max(low, -1.0) - 0.5)));
    const int last = std::min(width - 1, static_cast<int>(std::floor(std::min(high, width + 1.0) - 0.5)));
    if (first <= last) bits.set(row, first, last);
  }
}

void append_runs(const Bits& bits, int row, int width, std::vector<TexelRun>& runs) {
  const std::uint64_t* words = bits.row_words(row);
  int start = -1;
  for (int i = 0; i < width; ++i) {
    const bool on = (words[i / 64] >> (i % 64)) & 1;
    if (on && start < 0) start = i;
    if (!on && start >= 0) {
      runs.push_back({start, i - 1});
      start = -1;
    }
  }
  if (start >= 0) runs.push_back({start, width - 1});
}

}  // namespace

Eigen::Vector2d turned(const Eigen::Vector2d& uv, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * uv.x() - s * uv.y(), s * uv.x() + c * uv.y()};
}

ChartBitmap rasterise_chart(const Chart& chart, const BitmapSettings& settings) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(chart.uvs.size());
  for (const Eigen::Vector2d& uv : chart.uvs) points.push_back(turned(uv, settings.angle) * settings.texels_per_unit);
  Eigen::Vector2d lowest = points[0], highest = points[0];
  for (const Eigen::Vector2d& point : points) {
    lowest = lowest.cwiseMin(point);
    highest = highest.cwiseMax(point);
  }
  ChartBitmap bitmap;
  bitmap.angle = settings.angle;
  bitmap.origin = lowest - Eigen::Vector2d::Constant(settings.margin);
  const int width = static_cast<int>(std::ceil(highest.x() - bitmap.origin.x() + settings.margin)) + 1;
  const int height = static_cast<int>(std::ceil(highest.y() - bitmap.origin.y() + settings.margin)) + 1;

  Bits needed(width, height), touched(width, height);
  for (const Triangle& t : chart.triangles) {
    const std::array<Eigen::Vector2d, 3> p{points[t[0]] - bitmap.origin, points[t[1]] - bitmap.origin,
                                           points[t[2]] - bitmap.origin};
    fill_triangle(p, settings.margin, 0, needed, width);
    fill_triangle(p, settings.margin, 0.5, touched, width);
  }
  Bits result(width, height);
  for (int row = 0; row < height; ++row)
    for (int word = 0; word < needed.words_per_row(); ++word) {
      const std::uint64_t stray =
          touched.row_words(row)[word] & (settings.every_touched ? ~std::uint64_t{0} : ~needed.grown(row, word));
      result.row_words(row)[word] = needed.row_words(row)[word] | stray;
    }

  // Crop the empty rows and columns.
  bitmap.rows.resize(height);
  int left = width, right = -1, bottom = height, top = -1;
  for (int row = 0; row < height; ++row) {
    append_runs(result, row, width, bitmap.rows[row]);
    if (bitmap.rows[row].empty()) continue;
    left = std::min(left, bitmap.rows[row].front().first);
    right = std::max(right, bitmap.rows[row].back().last);
    bottom = std::min(bottom, row);
    top = row;
  }
  bitmap.rows.erase(bitmap.rows.begin() + top + 1, bitmap.rows.end());
  bitmap.rows.erase(bitmap.rows.begin(), bitmap.rows.begin() + bottom);
  for (std::vector<TexelRun>& row : bitmap.rows)
    for (TexelRun& run : row) {
      run.first -= left;
      run.last -= left;
      bitmap.texels += run.last - run.first + 1;
    }
  bitmap.width = right - left + 1;
  bitmap.height = top - bottom + 1;
  bitmap.origin += Eigen::Vector2d(left, bottom);
  return bitmap;
}

}  // namespace kiln
