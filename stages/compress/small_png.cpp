// SPDX-License-Identifier: GPL-3.0-or-later
#include "compress/small_png.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <vector>
#include <zlib.h>

namespace kiln {

namespace {

constexpr std::size_t most_tried_bytes = 1u << 20;
constexpr int trial_level = 4;            // level of zlib for trials; 9 takes up to ten times as long
constexpr int large_level = 8;            // level for large pictures; 9 takes several times as long for next to nothing
constexpr int filters = 5, adaptive = 5;  // none, sub, up, average, Paeth; or the best of them for each row
constexpr int paeth = 4;

using Bytes = std::vector<unsigned char>;

unsigned char predicted(int filter, int left, int up, int corner) {
  if (filter == 1) return static_cast<unsigned char>(left);
  if (filter == 2) return static_cast<unsigned char>(up);
  if (filter == 3) return static_cast<unsigned char>((left + up) / 2);
  if (filter == 4) {
    const int p = left + up - corner;
    const int to_left = std::abs(p - left), to_up = std::abs(p - up), to_corner = std::abs(p - corner);
    return static_cast<unsigned char>(to_left <= to_up && to_left <= to_corner ? left
                                      : to_up <= to_corner                     ? up
                                                                               : corner);
  }
  return 0;
}

/// Returns the rows of the file, top first, each as a filter's number and its bytes (PNG specification, second edition,
/// clause 9). `choice` is a filter, or `adaptive`: for each row the one with the least sum of absolute differences.
Bytes filtered(const Bytes& raw, std::size_t row_bytes, std::size_t texel_bytes, int choice) {
  const std::size_t rows = raw.size() / row_bytes;
  Bytes result;
  result.reserve(raw.size() + rows);
  Bytes best(row_bytes), trial(row_bytes);
  for (std::size_t row = 0; row < rows; ++row) {
    const unsigned char* here = raw.data() + row * row_bytes;
    const unsigned char* above = row > 0 ? here - row_bytes : nullptr;
    long least = std::numeric_limits<long>::max();
    int chosen = 0;
    for (int filter = choice == adaptive ? 0 : choice; filter <= (choice == adaptive ? filters - 1 : choice);
         ++filter) {
      long sum = 0;
      for (std::size_t i = 0; i < row_bytes; ++i) {
        const int left = i >= texel_bytes ? here[i - texel_bytes] : 0, up = above != nullptr ? above[i] : 0,
                  corner = above != nullptr && i >= texel_bytes ? above[i - texel_bytes] : 0;
        trial[i] = static_cast<unsigned char>(here[i] - predicted(filter, left, up, corner));
        sum += std::abs(static_cast<signed char>(trial[i]));
      }
      if (sum < least) {
        least = sum;
        chosen = filter;
        std::swap(best, trial);
      }
    }
    result.push_back(static_cast<unsigned char>(chosen));
    result.insert(result.end(), best.begin(), best.end());
  }
  return result;
}

Bytes deflated(const Bytes& data, int level, int strategy) {
  z_stream stream{};
  if (deflateInit2(&stream, level, Z_DEFLATED, 15, 9, strategy) != Z_OK) throw std::runtime_error("zlib cannot start");
  Bytes result(deflateBound(&stream, static_cast<uLong>(data.size())));
  stream.next_in = const_cast<Bytef*>(data.data());
  stream.avail_in = static_cast<uInt>(data.size());
  stream.next_out = result.data();
  stream.avail_out = static_cast<uInt>(result.size());
  const int end = deflate(&stream, Z_FINISH);
  result.resize(stream.total_out);
  deflateEnd(&stream);
  if (end != Z_STREAM_END) throw std::runtime_error("zlib cannot compress");
  return result;
}

/// Returns bands of rows, evenly spread over a picture of more than most_tried_bytes.
Bytes bands_of(const Bytes& raw, std::size_t row_bytes) {
  constexpr std::size_t band_rows = 64;
  const std::size_t rows = raw.size() / row_bytes;
  const std::size_t bands = std::max<std::size_t>(1, most_tried_bytes / (band_rows * row_bytes));
  Bytes part;
  for (std::size_t band = 0; band < bands; ++band) {
    const std::size_t first = band * rows / bands, count = std::min(band_rows, rows - first);
    const auto begin = raw.begin() + static_cast<std::ptrdiff_t>(first * row_bytes);
    part.insert(part.end(), begin, begin + static_cast<std::ptrdiff_t>(count * row_bytes));
  }
  return part;
}

/// Returns the smallest encoding among all filters and two strategies of zlib: Z_RLE, which gives the same at every
/// level and suits planes with noise, and Z_FILTERED, whose best filter a low level reveals. For a large picture the
/// choice is made on a part.
Bytes smallest_of_all(const Bytes& raw, std::size_t row_bytes, std::size_t texel_bytes) {
  struct Trial {
    Bytes bytes;
    int filter = 0;
  };
  const bool is_large = raw.size() > most_tried_bytes;
  const Bytes part = is_large ? bands_of(raw, row_bytes) : raw;
  Trial runs, matches;  // by Z_RLE, by Z_FILTERED
  for (int choice = 0; choice <= adaptive; ++choice) {
    const Bytes rows = filtered(part, row_bytes, texel_bytes, choice);
    for (auto [best, strategy] : {std::pair(&runs, Z_RLE), std::pair(&matches, Z_FILTERED)}) {
      Bytes trial = deflated(rows, trial_level, strategy);
      if (best->bytes.empty() || trial.size() < best->bytes.size()) *best = {std::move(trial), choice};
    }
  }
  if (is_large) {
    const bool has_runs = runs.bytes.size() < matches.bytes.size();
    const Bytes rows = filtered(raw, row_bytes, texel_bytes, has_runs ? runs.filter : matches.filter);
    return deflated(rows, large_level, has_runs ? Z_RLE : Z_FILTERED);
  }
  Bytes searched = deflated(filtered(raw, row_bytes, texel_bytes, matches.filter), 9, Z_FILTERED);
  return searched.size() < runs.bytes.size() ? std::move(searched) : std::move(runs.bytes);
}

void add_number(std::string& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<char>(value >> shift & 0xff));
}

void add_chunk(std::string& bytes, std::string_view kind, std::string_view body) {
  add_number(bytes, static_cast<std::uint32_t>(body.size()));
  std::string checked(kind);
  checked.append(body);
  bytes += checked;
  add_number(bytes, static_cast<std::uint32_t>(
                        crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()))));
}

}  // namespace

std::string encode_grey_png(const Image<std::uint16_t>& image, int bits, PngEffort effort) {
  const std::size_t texel_bytes = bits == 16 ? 2 : 1, row_bytes = texel_bytes * static_cast<std::size_t>(image.width());
  Bytes raw;
  raw.reserve(row_bytes * static_cast<std::size_t>(image.height()));
  for (int j = image.height() - 1; j >= 0; --j)
    for (int i = 0; i < image.width(); ++i) {
      if (bits == 16) raw.push_back(static_cast<unsigned char>(image.at(i, j) >> 8));
      raw.push_back(static_cast<unsigned char>(image.at(i, j) & 0xff));
    }

  const Bytes smallest = effort == PngEffort::quick
                             ? deflated(filtered(raw, row_bytes, texel_bytes, paeth), trial_level, Z_RLE)
                             : smallest_of_all(raw, row_bytes, texel_bytes);

  std::string header;
  add_number(header, static_cast<std::uint32_t>(image.width()));
  add_number(header, static_cast<std::uint32_t>(image.height()));
  header += {static_cast<char>(bits), 0, 0, 0, 0};  // grey, zlib, the five filters, not interlaced
  std::string file("\x89PNG\r\n\x1a\n");
  add_chunk(file, "IHDR", header);
  add_chunk(file, "IDAT", {reinterpret_cast<const char*>(smallest.data()), smallest.size()});
  add_chunk(file, "IEND", "");
  return file;
}

}  // namespace kiln
