// SPDX-License-Identifier: GPL-3.0-or-later
// The header of PLY files after [Turk 1994]; comments "TextureFile" after MeshLab (vcglib,
// wrap/io_trimesh/import_ply.h).

#include "import/ply_header.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/errors.h"
#include "import/readers.h"
#include "import/text_lines.h"
#include "import/text_words.h"

namespace kiln {

namespace {

constexpr std::size_t most_properties = 1000;

std::optional<PlyType> type_of(std::string_view name) {
  using enum PlyType;
  static constexpr std::array<std::pair<std::string_view, PlyType>, 22> names = {{
      {"char", int8},       {"uchar", uint8},      {"short", int16},    {"ushort", uint16}, {"int", int32},
      {"uint", uint32},     {"float", float32},    {"double", float64}, {"int8", int8},     {"uint8", uint8},
      {"int16", int16},     {"uint16", uint16},    {"int32", int32},    {"uint32", uint32}, {"float32", float32},
      {"float64", float64}, {"int64", int64},      {"uint64", uint64},  {"long", int64},    {"ulong", uint64},
      {"longlong", int64},  {"ulonglong", uint64},
  }};
  const auto* const found = std::ranges::find(names, name, &std::pair<std::string_view, PlyType>::first);
  return found == names.end() ? std::nullopt : std::optional(found->second);
}

class PlyHeaderReader {
 public:
  PlyHeaderReader(const std::string& file, std::string_view text) : file_(file), text_(text), lines_(text) {}

  PlyHeader read() {
    check_first_line();
    std::string_view line;
    for (;;) {
      if (!lines_.next(line)) throw truncated();
      std::string_view words = line;
      const std::string_view keyword = next_word(words);
      if (same_word(keyword, "end_header")) break;
      read_line(keyword, words);
    }
    if (!has_format_)
      throw BadInput(file_, "the header has no line 'format'",
                     "one such as 'format ascii 1.0' or 'format binary_little_endian 1.0'", export_again);
    find_data();
    return std::move(header_);
  }

 private:
  BadInput truncated() const {
    return BadInput(file_, "is truncated in its header, which has no line 'end_header'", "a whole PLY file",
                    export_again);
  }

  BadInput fail(const std::string& found, const std::string& expected) const {
    if (lines_.rest().empty() && lines_.number() > 1) return truncated();
    return BadInput(file_ + ":" + std::to_string(lines_.number()), found, expected, export_again);
  }

  void check_first_line() {
    std::string_view line, word;
    while (word.empty() && lines_.next(line)) word = next_word(line);
    if (same_word(word, "ply")) return;
    throw BadInput(file_, "begins with " + in_quotes(word), "a PLY file, whose first line is 'ply'",
                   "check what file it is");
  }

  void read_line(std::string_view keyword, std::string_view words) {
    if (keyword.empty() || same_word(keyword, "obj_info")) return;
    if (same_word(keyword, "comment"))
      read_comment(words);
    else if (same_word(keyword, "format"))
      read_format(words);
    else if (same_word(keyword, "element"))
      read_element(words);
    else if (same_word(keyword, "property"))
      read_property(words);
    else
      throw fail("the header has the unknown word " + in_quotes(keyword),
                 "format, element, property, comment, obj_info or end_header");
  }

  void read_comment(std::string_view words) {
    if (!same_word(next_word(words), "TextureFile")) return;
    std::string_view name = trimmed(words);
    if (name.size() > 2 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
    if (!name.empty()) header_.textures.push_back({std::string(name), lines_.number()});
  }

  void read_format(std::string_view words) {
    using enum PlyHeader::Format;
    const std::string_view name = next_word(words), version = next_word(words);
    if (same_word(name, "ascii"))
      header_.format = ascii;
    else if (same_word(name, "binary_little_endian"))
      header_.format = little_endian;
    else if (same_word(name, "binary_big_endian"))
      header_.format = big_endian;
    else
      throw fail("the unknown format " + in_quotes(name), "ascii, binary_little_endian or binary_big_endian");
    has_format_ = true;
    if (version != "1.0")
      header_.warnings.push_back("line " + std::to_string(lines_.number()) + " has the format's version " +
                                 in_quotes(version) + ", which is read as 1.0");
  }

  void read_element(std::string_view words) {
    PlyElement element;
    element.name = next_word(words);
    element.line = lines_.number();
    const std::string_view count = next_word(words);
    const auto number = parse_integer(count);
    if (!number || *number < 0)
      throw fail("the element " + in_quotes(element.name) + " has the count " + in_quotes(count),
                 "a whole number, 0 or more");
    element.count = static_cast<std::uint64_t>(*number);
    const auto has_name = [&](const PlyElement& other) { return other.name == element.name; };
    if (element.name == "vertex" && std::ranges::any_of(header_.elements, has_name))
      throw fail("a second element 'vertex'", "one");
    header_.elements.push_back(std::move(element));
  }

  PlyType read_type(std::string_view name) const {
    if (const auto type = type_of(name)) return *type;
    throw fail("the unknown type " + in_quotes(name),
               "char, uchar, short, ushort, int, uint, float, double, or a type such as int8, uint16 or float32");
  }

  void read_property(std::string_view words) {
    if (header_.elements.empty()) throw fail("a property before the first element", "a line 'element' before it");
    PlyProperty property;
    std::string_view type = next_word(words);
    property.is_list = same_word(type, "list");
    if (property.is_list) {
      property.count_type = read_type(next_word(words));
      type = next_word(words);
    }
    property.type = read_type(type);
    property.name = next_word(words);
    if (property.name.empty()) throw fail("a property without a name", "a name after the type");
    PlyElement& element = header_.elements.back();
    if (element.properties.size() == most_properties)
      throw fail(
          "more than " + std::to_string(most_properties) + " properties of the element " + in_quotes(element.name),
          "a few");
    if (element.find(property.name, property.is_list))
      throw fail("a second property " + in_quotes(property.name) + " of the element " + in_quotes(element.name), "one");
    element.properties.push_back(std::move(property));
  }

  /// Finds where the data begins. In a header whose lines end with a carriage return alone, a line feed is data.
  void find_data() {
    header_.line_count = lines_.number();
    header_.size = text_.size() - lines_.rest().size();
    const std::size_t first_end = text_.find_first_of("\r\n");
    const bool return_alone = text_[first_end] == '\r' && text_.substr(first_end + 1, 1) != "\n";
    if (return_alone && header_.format != PlyHeader::Format::ascii && text_[header_.size - 1] == '\n') --header_.size;
  }

  const std::string& file_;
  std::string_view text_;
  TextLines lines_;
  PlyHeader header_;
  bool has_format_ = false;
};

}  // namespace

std::size_t size_of(PlyType type) {
  using enum PlyType;
  if (type == int8 || type == uint8) return 1;
  if (type == int16 || type == uint16) return 2;
  return type == int64 || type == uint64 || type == float64 ? 8 : 4;
}

bool is_float(PlyType type) { return type == PlyType::float32 || type == PlyType::float64; }

std::optional<std::size_t> PlyElement::find(std::string_view property, bool is_list) const {
  for (std::size_t i = 0; i < properties.size(); ++i)
    if (properties[i].name == property && properties[i].is_list == is_list) return i;
  return std::nullopt;
}

std::vector<std::size_t> PlyElement::find_group(std::initializer_list<std::vector<std::string_view>> groups) const {
  for (const std::vector<std::string_view>& group : groups) {
    std::vector<std::size_t> found;
    for (const std::string_view property : group)
      if (const auto index = find(property, false)) found.push_back(*index);
    if (found.size() == group.size()) return found;
  }
  return {};
}

PlyHeader read_ply_header(const std::string& file, std::string_view text) { return PlyHeaderReader(file, text).read(); }

}  // namespace kiln
