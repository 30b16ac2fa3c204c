// SPDX-License-Identifier: GPL-3.0-or-later
// ZBrush describes its comments in the files that it writes: "The following MRGB block contains ZBrush Vertex Color
// (Polypaint) and masking output as 4 hexadecimal values per vertex. The vertex color format is MMRRGGBB with up to 64
// entries per MRGB line." Colours after coordinates: [Bourke 2020].
#include "import/obj_colors.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "import/wavefront_lines.h"

namespace kiln {

namespace {

constexpr std::size_t digits_per_color = 8;

std::optional<std::uint32_t> parse_hexadecimal(std::string_view digits) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return value;
}

Eigen::Vector3f color_of(std::uint32_t mrgb) {
  const auto part = [&](int shift) { return static_cast<float>(mrgb >> shift & 255) / 255; };
  return {part(16), part(8), part(0)};
}

}  // namespace

void ObjColors::set(std::size_t index, const Eigen::Vector3f& color) {
  if (colors_.size() <= index) {
    colors_.resize(index + 1, Eigen::Vector3f::Ones());
    has_color_.resize(index + 1, false);
  }
  colors_[index] = color;
  has_color_[index] = true;
}

void ObjColors::add_polypaint(std::string_view digits, std::size_t vertex_count) {
  if (polypaint_.empty() || polypaint_.back().vertex_count != vertex_count) polypaint_.push_back({vertex_count, {}});
  digits = trimmed(digits);
  bad_polypaint_ += digits.size() % digits_per_color != 0;
  for (; digits.size() >= digits_per_color; digits.remove_prefix(digits_per_color)) {
    const std::optional<std::uint32_t> color = parse_hexadecimal(digits.substr(0, digits_per_color));
    bad_polypaint_ += !color;
    polypaint_.back().colors.push_back(color.value_or(0xffffffff));
  }
}

void ObjColors::take_polypaint(std::size_t vertex_count, std::vector<std::string>& warnings) {
  std::size_t count = 0;
  for (const Polypaint& block : polypaint_) count += block.colors.size();
  if (count > 0) {
    colors_.resize(vertex_count, Eigen::Vector3f::Ones());
    has_color_.resize(vertex_count, false);
  }
  const bool in_order = count == vertex_count || polypaint_.front().vertex_count == 0;
  std::size_t next = 0, dropped = 0;
  for (const Polypaint& block : polypaint_) {
    // A block for fewer vertices belongs to the last object before it.
    if (!in_order) next = std::max(next, block.vertex_count - std::min(block.vertex_count, block.colors.size()));
    const std::size_t end = in_order ? vertex_count : block.vertex_count;
    for (const std::uint32_t color : block.colors) {
      dropped += next >= end;
      if (next >= end) continue;
      colors_[next] = color_of(color);
      has_color_[next++] = true;
    }
  }
  if (dropped > 0)
    warnings.push_back(counted(dropped, "polypaint colour") + " (#MRGB) more than vertices are not used");
  if (bad_polypaint_ > 0)
    warnings.push_back("polypaint (#MRGB) is damaged: " + counted(bad_polypaint_, "time") +
                       " it has other than 8 hexadecimal digits for a vertex");
}

/// Scales the colours of `v` lines to 0 .. 1.
void ObjColors::scale(std::vector<std::string>& warnings) {
  const auto outside = [](const Eigen::Vector3f& color) {
    return color.allFinite() && (color.minCoeff() < 0 || color.maxCoeff() > 1);
  };
  const auto is_byte = [](float value) { return !(value < 0 || value > 255 || value != std::floor(value)); };
  const auto are_bytes = [&](const Eigen::Vector3f& color) {
    return !color.allFinite() || (is_byte(color.x()) && is_byte(color.y()) && is_byte(color.z()));
  };
  const auto count = static_cast<std::size_t>(std::count_if(colors_.begin(), colors_.end(), outside));
  if (count == 0) return;
  if (std::all_of(colors_.begin(), colors_.end(), are_bytes)) {
    for (std::size_t k = 0; k < colors_.size(); ++k)
      if (has_color_[k]) colors_[k] /= 255;
    warnings.emplace_back("vertex colours are whole numbers up to 255, and taken for bytes: 255 is 1");
    return;
  }
  for (Eigen::Vector3f& color : colors_)
    if (outside(color)) color = color.cwiseMax(0).cwiseMin(1).eval();
  warnings.push_back(counted(count, "vertex colour") + " outside 0 to 1, clamped to that");
}

std::vector<Eigen::Vector3f> ObjColors::finish(const std::vector<bool>& is_used, std::vector<std::string>& warnings) {
  if (!colors_.empty()) {
    scale(warnings);
    if (!polypaint_.empty()) warnings.emplace_back("polypaint (#MRGB) is not used beside the colours on vertex lines");
  } else if (!polypaint_.empty()) {
    take_polypaint(is_used.size(), warnings);
  }
  if (colors_.empty()) return {};
  colors_.resize(is_used.size(), Eigen::Vector3f::Ones());
  has_color_.resize(is_used.size(), false);
  std::size_t missing = 0;
  for (std::size_t k = 0; k < is_used.size(); ++k) missing += is_used[k] && !has_color_[k];
  if (missing > 0)
    warnings.push_back(counted(missing, "vertex", "vertices") +
                       " without a colour among others that have one, taken for white");
  return std::move(colors_);
}

}  // namespace kiln
