// SPDX-License-Identifier: GPL-3.0-or-later
// STL files, ASCII and binary, after [3D Systems 1989]; colours in the attribute bytes after Materialise Magics and
// VisCAM/SolidView (en.wikipedia.org/wiki/STL_(file_format)#Color_in_binary). Normals of facets only repeat the winding
// and are ignored.

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

#include "base/errors.h"
#include "base/files.h"
#include "import/coordinates.h"
#include "import/readers.h"
#include "import/stored_colors.h"
#include "import/text_lines.h"
#include "import/text_words.h"

namespace kiln {

namespace {

namespace fs = std::filesystem;

constexpr char expected_triangles[] = "a mesh of triangles";
constexpr std::size_t stl_header_size = 84, record_size = 50;

/// Tells whether a text begins with a word, in any case of letters.
bool has_word(std::string_view text, std::string_view word) {
  return std::search(text.begin(), text.end(), word.begin(), word.end(), [](char a, char b) {
           return same_word({&a, 1}, {&b, 1});
         }) != text.end();
}

std::string triangle_name(std::size_t triangle, std::size_t count) {
  return "triangle " + std::to_string(triangle + 1) + " of " + std::to_string(count);
}

class StlText {
 public:
  StlText(const std::string& file, std::string_view text) : file_(file), words_(file, text) {}

  SourceMesh read() {
    pass_comments();
    while (words_.to_word()) read_word(words_.next_on_line());
    if (in_facet_) throw truncated();
    if (in_solid_) mesh_.warnings.emplace_back("the last solid has no 'endsolid'; the file may have been cut short");
    check_places();
    return std::move(mesh_);
  }

 private:
  /// Skips the lines before the first that begins with 'solid' or 'facet'.
  void pass_comments() {
    while (words_.to_word()) {
      TextWords ahead = words_;
      const std::string_view word = ahead.next_on_line();
      if (same_word(word, "solid") || same_word(word, "facet")) return;
      words_.skip_line();
    }
  }

  void read_word(std::string_view word) {
    const auto is = [&](std::string_view other) { return same_word(word, other); };
    if (is("vertex")) return read_vertex();
    if (is("facet")) return begin_facet();
    if (is("outer") || is("loop")) return;
    if (is("endloop")) return end_loop();
    if (is("endfacet")) return end_facet();
    if (is("solid") || is("endsolid")) return read_solid(is("solid"));
    if (is("end")) {  // "end solid", "end facet"
      if (const std::string_view next = words_.next_on_line(); !next.empty())
        return read_word("end" + std::string(next));
    }
    if (word.front() == '#' || word.front() == ';' || word.starts_with("//")) return words_.skip_line();
    if (words_.rest().empty()) throw truncated();
    throw BadInput(words_.where(), "the unknown word " + in_quotes(word),
                   "solid, facet normal, outer loop, vertex, endloop, endfacet or endsolid", export_again);
  }

  /// Skips a solid's name, which ends with its line, or before a facet on that line.
  void read_solid(bool begins) {
    if (in_facet_) throw odd("'solid' or 'endsolid' within a facet");
    in_solid_ = begins;
    for (;;) {
      TextWords ahead = words_;
      const std::string_view word = ahead.next_on_line();
      if (word.empty() || (same_word(word, "facet") && same_word(ahead.next_on_line(), "normal"))) return;
      words_.next_on_line();
    }
  }

  BadInput truncated() const {
    return BadInput(file_,
                    "is truncated: it ends within facet " + std::to_string(mesh_.faces.size() + (has_loop_ ? 0 : 1)),
                    "a whole STL file", export_again);
  }

  BadInput odd(const std::string& found) const {
    return BadInput(words_.where(), found, "facet, outer loop, vertices, endloop and endfacet in this order",
                    export_again);
  }

  void begin_facet() {
    if (in_facet_) throw odd("a facet within a facet");
    in_facet_ = true;
    facet_line_ = words_.line();
    TextWords ahead = words_;
    if (!same_word(ahead.next_on_line(), "normal")) return;
    for (int i = 0; i < 4; ++i) {  // the word and three numbers, in any form
      words_ = ahead;
      const std::string_view word = ahead.next_on_line();
      if (word.empty() || same_word(word, "outer")) return;
    }
  }

  void read_vertex() {
    Eigen::Vector3d place;
    const std::string where = words_.where();
    for (double& value : place) {
      const std::string_view word = words_.next_on_line();
      if (word.empty() && words_.rest().empty()) throw truncated();
      if (word.empty()) throw BadInput(where, "a vertex of fewer than three numbers", "three numbers", export_again);
      value = words_.number(word);
      precision_.add(word);
    }
    if (!in_facet_) throw odd("a vertex outside of a facet");
    corners_.push_back(place);
  }

  void end_loop() {
    if (!in_facet_) throw odd("'endloop' outside of a facet");
    if (corners_.size() < 3)
      throw BadInput(words_.where(), "a facet of " + counted(corners_.size(), "vertex", "vertices"), "three vertices",
                     export_again);
    if (mesh_.places.size() + corners_.size() >= SourceMesh::none)
      throw BadInput(words_.where(), "more than 4294967294 vertices", "fewer", "split the mesh");
    SourceMesh::Face face;
    face.first_corner = static_cast<std::uint32_t>(mesh_.corners.size());
    face.corner_count = static_cast<std::uint32_t>(corners_.size());
    face.line = facet_line_;
    for (const Eigen::Vector3d& place : corners_) {
      mesh_.corners.push_back({.place = static_cast<std::uint32_t>(mesh_.places.size())});
      mesh_.places.push_back(place);
    }
    mesh_.faces.push_back(face);
    corners_.clear();
    has_loop_ = true;
  }

  void end_facet() {
    if (!in_facet_) throw odd("'endfacet' outside of a facet");
    if (!corners_.empty() || !has_loop_) end_loop();
    in_facet_ = has_loop_ = false;
  }

  void check_places() {
    if (mesh_.faces.empty()) throw BadInput(file_, "has no facets", expected_triangles, export_again);
    mesh_.is_unwelded = true;
    const double largest = largest_used_coordinate(file_, mesh_, [&](std::uint32_t place) {
      const auto after = std::ranges::upper_bound(mesh_.faces, place, {}, &SourceMesh::Face::first_corner);
      return "the facet in line " + std::to_string((after - 1)->line);
    });
    const double text = precision_.of(largest);
    mesh_.precision = text == 0 ? 0 : std::max(text, float_precision(largest));
  }

  const std::string& file_;
  TextWords words_;
  SourceMesh mesh_;
  TextPrecision precision_;
  std::vector<Eigen::Vector3d> corners_;
  std::uint32_t facet_line_ = 0;
  bool in_solid_ = false, in_facet_ = false, has_loop_ = false;
};

template <class Value>
Value little_endian(const char* at) {
  std::array<char, sizeof(Value)> bytes;
  std::memcpy(bytes.data(), at, sizeof(Value));
  if (std::endian::native == std::endian::big) std::ranges::reverse(bytes);
  return std::bit_cast<Value>(bytes);
}

/// Returns red, green and blue of 5 bits each, the first in the lowest bits.
Eigen::Vector3f from_15_bits(std::uint16_t bits) {
  return Eigen::Vector3f(static_cast<float>(bits & 31), static_cast<float>(bits >> 5 & 31),
                         static_cast<float>(bits >> 10 & 31)) /
         31;
}

class StlBinary {
 public:
  StlBinary(const fs::path& path, const std::string& file, std::string_view text)
      : path_(path), file_(file), text_(text), count_(number_of_triangles()) {}

  SourceMesh read() {
    mesh_.places.resize(3 * count_);
    mesh_.corners.resize(3 * count_);
    mesh_.faces.resize(count_);
    for (std::size_t i = 0; i < count_; ++i) {
      const char* const record = text_.data() + stl_header_size + i * record_size;
      for (std::size_t k = 0; k < 3; ++k) {
        const char* const vertex = record + 12 * (k + 1);  // after the normal
        mesh_.places[3 * i + k] = Eigen::Vector3f(little_endian<float>(vertex), little_endian<float>(vertex + 4),
                                                  little_endian<float>(vertex + 8))
                                      .cast<double>();
        mesh_.corners[3 * i + k].place = static_cast<std::uint32_t>(3 * i + k);
      }
      mesh_.faces[i].first_corner = static_cast<std::uint32_t>(3 * i);
      mesh_.faces[i].corner_count = 3;
    }
    if (count_ == 0) throw BadInput(file_, "has no triangles", expected_triangles, export_again);
    mesh_.is_unwelded = true;
    mesh_.precision = float_precision(
        largest_used_coordinate(file_, mesh_, [&](std::uint32_t place) { return triangle_name(place / 3, count_); }));
    read_colors();
    return std::move(mesh_);
  }

 private:
  /// Returns the number of triangles by the header, or by the file's size where the two differ.
  std::size_t number_of_triangles() {
    if (text_.size() < stl_header_size)
      throw BadInput(
          file_, "is truncated: it has " + std::to_string(text_.size()) + " bytes",
          "84 bytes of header and 50 for each triangle of a binary STL file, or a text that begins with 'solid'",
          export_again);
    const std::uint64_t counted_there = little_endian<std::uint32_t>(text_.data() + 80);
    const std::size_t data = text_.size() - stl_header_size, records = data / record_size;
    const std::string numbers = "its header counts " + counted(counted_there, "triangle", "triangles") +
                                ", and it holds " + std::to_string(records) +
                                (data % record_size == 0 ? "" : " and " + counted(data % record_size, "byte", "bytes"));
    if (records >= SourceMesh::none / 3)
      throw BadInput(file_, "holds " + std::to_string(records) + " triangles", "fewer than 1431655765",
                     "split the mesh");
    if (counted_there == records && data % record_size == 0) return records;
    if (data % record_size == 0 && records > 0) {
      mesh_.warnings.push_back(numbers + ", all of which were taken");
      return records;
    }
    if (counted_there > records) throw BadInput(file_, "is truncated: " + numbers, "a whole STL file", export_again);
    if (counted_there == 0) throw BadInput(file_, numbers, "the number of triangles that follow", export_again);
    mesh_.warnings.push_back(counted(data - counted_there * record_size, "byte follows", "bytes follow") +
                             " the last of the " + counted(counted_there, "triangle", "triangles") +
                             " that the header counts and are not used");
    return counted_there;
  }

  std::uint16_t attribute(std::size_t triangle) const {
    return little_endian<std::uint16_t>(text_.data() + stl_header_size + triangle * record_size + 48);
  }

  /// Reads colours from the attribute bytes. Materialise's, which the header announces, have red in the lowest bits,
  /// and bit 15 means the solid's own colour. VisCAM's have blue in the lowest bits, and bit 15 means that there is a
  /// colour.
  void read_colors() {
    bool any = false, all_valid = true;
    for (std::size_t i = 0; i < count_; ++i) {
      const std::uint16_t bits = attribute(i);
      any |= bits != 0;
      all_valid &= bits == 0 || bits >= 0x8000;
    }
    const std::size_t default_at = text_.substr(0, 80).find("COLOR=");
    const bool is_materialise = default_at != std::string_view::npos && default_at + 10 <= 80;
    if (!is_materialise && !any) return;
    if (!is_materialise && !all_valid) {
      mesh_.warnings.emplace_back("the attribute bytes of triangles are not used; they are no colours");
      return;
    }
    Eigen::Vector3f whole = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
    for (int k = 0; is_materialise && k < 3; ++k)
      whole[k] =
          static_cast<float>(static_cast<unsigned char>(text_[default_at + 6 + static_cast<std::size_t>(k)])) / 255;
    std::vector<Eigen::Vector3f> colors(count_, whole);
    for (std::size_t i = 0; any && i < count_; ++i) {
      const std::uint16_t bits = attribute(i);
      const bool has_own = is_materialise == (bits < 0x8000);
      if (!has_own) continue;
      const Eigen::Vector3f color = from_15_bits(bits);
      colors[i] = is_materialise ? color : Eigen::Vector3f(color.reverse());
    }
    use_face_colors(mesh_, colors, path_.filename().string() + ": colours of triangles");
  }

  const fs::path& path_;
  const std::string& file_;
  std::string_view text_;
  SourceMesh mesh_;
  std::size_t count_;
};

bool is_binary(const std::string& file, std::string_view text) {
  if (text.size() > stl_header_size &&
      text.size() == stl_header_size + record_size * std::size_t{little_endian<std::uint32_t>(text.data() + 80)})
    return true;
  const std::string_view beginning = text.substr(0, 65536);
  const std::string_view first = trimmed(beginning.substr(0, beginning.find_first_of("\r\n")));
  const bool has_zeros = beginning.find('\0') != std::string_view::npos;
  const bool has_facets = has_word(beginning, "facet") && has_word(beginning, "vertex");
  const bool is_solid = first.size() >= 5 && same_word(first.substr(0, 5), "solid");
  if (has_facets || (!has_zeros && is_solid)) return false;
  if (!has_zeros &&
      std::ranges::all_of(beginning.substr(0, stl_header_size), [](char c) { return c >= '\t' && c < 0x7f; }))
    throw BadInput(file, "begins with " + in_quotes(first), "an STL file, ASCII or binary", "check what file it is");
  return true;
}

}  // namespace

SourceMesh read_stl(const fs::path& file) {
  const std::string name = file.string(), bytes = read_text(file);
  if (bytes.empty()) throw BadInput(name, "is empty", expected_triangles, export_again);
  std::string_view text = bytes;
  if (is_binary(name, without_byte_order_mark(text))) return StlBinary(file, name, text).read();
  text = without_byte_order_mark(text);
  return StlText(name, text).read();
}

}  // namespace kiln
