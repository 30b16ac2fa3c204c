// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kiln {

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

/// Returns the size of a type in bytes.
std::size_t size_of(PlyType type);

bool is_float(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;  ///< type of a list's items, if it is a list
  bool is_list = false;
  PlyType count_type = PlyType::uint8;  ///< type of a list's length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  std::uint32_t line = 0;  ///< line of the header, from 1

  /// Returns the index of the property of that name that is (or is not) a list.
  std::optional<std::size_t> find(std::string_view property, bool is_list) const;

  /// Returns the indices of the first group of names that all exist as scalars. Empty where there is none.
  std::vector<std::size_t> find_group(std::initializer_list<std::vector<std::string_view>> groups) const;
};

/// Picture that a comment of the header names.
struct PlyTexture {
  std::string name;
  std::uint32_t line = 0;
};

struct PlyHeader {
  enum class Format { ascii, little_endian, big_endian };

  Format format = Format::ascii;
  std::vector<PlyElement> elements;
  std::vector<PlyTexture> textures;
  std::size_t size = 0;          ///< offset of the data, in bytes
  std::uint32_t line_count = 0;  ///< number of lines before the data
  std::vector<std::string> warnings;
};

/// Reads the header of a PLY file, whose whole content is `text`. Throws BadInput, with the line.
PlyHeader read_ply_header(const std::string& file, std::string_view text);

}  // namespace kiln
