// SPDX-License-Identifier: GPL-3.0-or-later
// OFF files, text and binary, after the Geomview manual, "OFF Files" (geomview.org/docs/html/OFF.html); colours after
// the coordinates of vertices without the keyword COFF after MeshLab (vcglib, wrap/io_trimesh/import_off.h).

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "base/errors.h"
#include "base/files.h"
#include "import/off_mesh.h"
#include "import/readers.h"
#include "import/text_words.h"

namespace kiln {

namespace {

namespace fs = std::filesystem;

/// Words of a line, or of several, and their numbers.
struct Words {
  std::vector<std::string_view> words;
  std::vector<double> numbers;

  void add(const TextWords& text, std::string_view word) {
    words.push_back(word);
    numbers.push_back(text.number(word));
  }
  void clear() {
    words.clear();
    numbers.clear();
  }
  std::size_t size() const { return words.size(); }
};

class OffText {
 public:
  OffText(const fs::path& path, const std::string& file, const OffHeader& header, std::string_view text)
      : header_(header), words_(file, text, header.line, '#'), mesh_(path, header, text.size()) {}

  SourceMesh read() {
    find_layout();
    for (std::uint64_t i = 0; i < header_.vertex_count; ++i) read_vertex();
    for (std::uint64_t i = 0; i < header_.face_count; ++i) read_face();
    if (words_.to_word())
      mesh_.warnings.push_back(counted(words_.rest().size(), "byte follows", "bytes follow") +
                               " the last face and are not used");
    if (other_numbers_ > 0)
      mesh_.warnings.push_back(counted(other_numbers_, "vertex or face has", "vertices and faces have") +
                               " numbers behind the usual ones that are no colours and are not used");
    return mesh_.take();
  }

 private:
  std::size_t uv_size() const { return header_.has_uvs ? 2 : 0; }

  /// Finds out whether each vertex has a line, or vertices run across lines: they do where the first line has too few
  /// words.
  void find_layout() {
    TextWords ahead = words_;
    std::size_t count = 0;
    for (ahead.to_word(); !ahead.next_on_line().empty();) ++count;
    spread_ = count < mesh_.place_size() + uv_size();
  }

  void read_vertex() {
    read_vertex_words();
    const std::size_t place_size = mesh_.place_size();
    const std::size_t color_size = line_.size() - place_size - uv_size();
    const std::span<const double> numbers = line_.numbers;
    for (std::size_t i = 0; i < 3; ++i) mesh_.text_precision.add(line_.words[i]);
    mesh_.add_vertex(numbers.first(place_size));
    if (header_.has_uvs) mesh_.add_uv(numbers[numbers.size() - 2], numbers[numbers.size() - 1]);
    if (color_size == 3 || color_size == 4)
      mesh_.vertex_colors.add_text(mesh_.vertex_count() - 1, std::span(line_.words).subspan(place_size, color_size),
                                   numbers.subspan(place_size, color_size), mesh_.color_scale);
    const bool is_color = color_size == 0 || color_size == 3 || color_size == 4;
    other_numbers_ += !is_color;
    if (header_.has_colors && (color_size < 3 || !is_color))
      throw BadInput(words_.where(), "a vertex of " + counted(line_.size(), "number", "numbers"),
                     "its coordinates and three or four numbers of its colour", export_again);
  }

  void read_vertex_words() {
    line_.clear();
    if (!words_.to_word()) mesh_.throw_truncated(mesh_.next_vertex_name());
    const std::size_t least = mesh_.place_size() + uv_size(), whole = least + (header_.has_colors ? 4 : 0);
    while (!spread_ || line_.size() < whole) {
      const std::string_view word = spread_ ? words_.next() : words_.next_on_line();
      if (word.empty()) break;
      line_.add(words_, word);
    }
    if (line_.size() >= least) return;
    const std::string where = words_.where(), name = mesh_.next_vertex_name();
    if (!words_.to_word()) mesh_.throw_truncated(name);
    throw BadInput(where, name + " has " + counted(line_.size(), "number", "numbers"),
                   std::to_string(least) + " or more", export_again);
  }

  void read_face() {
    if (!words_.to_word()) mesh_.throw_truncated(mesh_.face_name(mesh_.face_count()));
    const std::uint32_t line = words_.line();
    const double count = words_.whole_number(words_.next_on_line());
    mesh_.begin_face(count, words_.rest().size() / 2, line);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      const std::string_view word = spread_ ? words_.next() : words_.next_on_line();
      if (word.empty()) fail_in_face(count);
      mesh_.add_corner(words_.whole_number(word));
    }
    line_.clear();
    for (std::string_view word; !(word = words_.next_on_line()).empty();) line_.add(words_, word);
    add_face_color();
  }

  [[noreturn]] void fail_in_face(double count) {
    const std::string where = words_.where(), name = mesh_.face_name(mesh_.face_count() - 1);
    if (!words_.to_word()) mesh_.throw_truncated(name);
    throw BadInput(where, name + " has too few indices", counted(static_cast<std::uint64_t>(count), "index", "indices"),
                   export_again);
  }

  void add_face_color() {
    if (line_.size() == 3 || line_.size() == 4)
      mesh_.face_colors.add_text(mesh_.face_count() - 1, line_.words, line_.numbers, mesh_.color_scale);
    if (line_.size() == 1) mesh_.add_mapped_color();
    other_numbers_ += line_.size() == 2 || line_.size() > 4;
  }

  const OffHeader header_;
  TextWords words_;
  OffMesh mesh_;
  Words line_;
  bool spread_ = false;
  std::uint64_t other_numbers_ = 0;
};

/// Reader of a binary file's 32-bit numbers.
class OffBinary {
 public:
  OffBinary(const fs::path& path, const std::string& file, OffHeader header, std::string_view data)
      : file_(file), data_(data), header_(read_counts(header)), mesh_(path, header_, data.size()) {}

  SourceMesh read() {
    const std::size_t size = mesh_.place_size() + (header_.has_colors ? 4 : 0) + (header_.has_uvs ? 2 : 0);
    std::vector<double> numbers(size);
    for (std::uint64_t i = 0; i < header_.vertex_count; ++i) {
      if (data_.size() < 4 * size) mesh_.throw_truncated(mesh_.next_vertex_name());
      for (double& number : numbers) number = next_float();
      const std::span<const double> all = numbers;
      mesh_.add_vertex(all.first(mesh_.place_size()));
      if (header_.has_colors)
        mesh_.vertex_colors.add_floats(mesh_.vertex_count() - 1, all.subspan(mesh_.place_size(), 4), mesh_.color_scale);
      if (header_.has_uvs) mesh_.add_uv(all[size - 2], all[size - 1]);
    }
    for (std::uint64_t i = 0; i < header_.face_count; ++i) read_face();
    if (!data_.empty())
      mesh_.warnings.push_back(counted(data_.size(), "byte follows", "bytes follow") +
                               " the last face and are not used");
    if (is_little_) mesh_.warnings.emplace_back("its numbers are little-endian, where the format has them big-endian");
    return mesh_.take();
  }

 private:
  std::uint32_t next_bits() {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 4; ++i)
      bits |= std::uint32_t{static_cast<unsigned char>(data_[i])} << 8 * (is_little_ ? i : 3 - i);
    data_.remove_prefix(4);
    return bits;
  }
  double next_integer() { return static_cast<std::int32_t>(next_bits()); }
  double next_float() { return std::bit_cast<float>(next_bits()); }

  /// Reads the numbers of vertices, faces and edges. A file too short for them is little-endian if it is long enough
  /// for the counts read that way.
  OffHeader read_counts(OffHeader header) {
    if (data_.size() < 12)
      throw BadInput(file_, "is truncated: it ends within the numbers of vertices, faces and edges", "a whole OFF file",
                     export_again);
    const std::string_view all = data_;
    const auto read = [&](bool is_little) {
      is_little_ = is_little;
      data_ = all;
      header.vertex_count = next_bits();
      header.face_count = next_bits();
      next_bits();
      return 12 * (header.vertex_count + header.face_count) <= data_.size();
    };
    if (!read(false) && !read(true)) read(false);
    if ((header.vertex_count | header.face_count) > 0x7fffffff)
      throw BadInput(file_, "a negative number of vertices or faces", "whole numbers, 0 or more", export_again);
    return header;
  }

  void read_face() {
    const auto name = [&] { return mesh_.face_name(mesh_.face_count() - 1); };
    if (data_.size() < 4) mesh_.throw_truncated(mesh_.face_name(mesh_.face_count()));
    const double count = next_integer();
    mesh_.begin_face(count, data_.size() / 4, 0);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) mesh_.add_corner(next_integer());
    if (data_.size() < 4) mesh_.throw_truncated(name());
    const double size = next_integer();
    if (size < 0 || size > 4)
      throw BadInput(file_, name() + " has a colour of " + std::to_string(static_cast<int>(size)) + " numbers",
                     "0, 1, 3 or 4 numbers", export_again);
    if (static_cast<double>(data_.size()) < 4 * size) mesh_.throw_truncated(name());
    std::array<double, 4> color{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(size); ++i) color[i] = next_float();
    if (size >= 3)
      mesh_.face_colors.add_floats(mesh_.face_count() - 1, std::span(color).first(static_cast<std::size_t>(size)),
                                   mesh_.color_scale);
    if (size == 1) mesh_.add_mapped_color();
  }

  const std::string& file_;
  std::string_view data_;
  bool is_little_ = false;
  const OffHeader header_;
  OffMesh mesh_;
};

}  // namespace

SourceMesh read_off(const fs::path& file) {
  const std::string name = file.string(), text = read_text(file);
  if (text.empty()) throw BadInput(name, "is empty", "a mesh of triangles or polygons", export_again);
  const OffHeader header = read_off_header(name, text);
  const std::string_view data = std::string_view(text).substr(header.size);
  return header.is_binary ? OffBinary(file, name, header, data).read() : OffText(file, name, header, data).read();
}

}  // namespace kiln
