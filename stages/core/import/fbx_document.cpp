// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/fbx_document.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <zlib.h>

#include "base/errors.h"
#include "base/files.h"
#include "import/fbx_text.h"
#include "import/text_lines.h"

// The binary form follows [Blender 2013]: a tree of records with their end, values and name. Assimp 5.2, tried instead,
// rounds coordinates and transforms to floats, lets children inherit their parents' geometric transforms, and frees
// memory twice on damaged files.

namespace kiln {

namespace {

constexpr std::string_view binary_magic{"Kaydara FBX Binary  \0", 21};
constexpr std::size_t fbx_header_size = 27;
constexpr int deepest_record = 50;  // levels; FBX files have about six

template <class Number>
Number read_at(std::string_view bytes, std::size_t at) {
  Number number;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

/// Reads the records of a binary file.
class BinaryParser {
 public:
  BinaryParser(const FbxDocument& document, std::string_view bytes)
      : document_(document), bytes_(bytes), wide_(read_at<std::uint32_t>(bytes, 23) >= 7500) {}

  void parse(FbxRecord& root) {
    at_ = fbx_header_size;
    while (parse_record(root, bytes_.size(), 0)) {
    }
  }

 private:
  [[noreturn]] void truncated() const {
    document_.fail("is truncated at byte " + std::to_string(bytes_.size()), "a whole FBX file", "copy it again");
  }

  template <class Number>
  Number take() {
    if (sizeof(Number) > bytes_.size() - at_) truncated();
    at_ += sizeof(Number);
    return read_at<Number>(bytes_, at_ - sizeof(Number));
  }

  std::string_view take_bytes(std::size_t count) {
    if (count > bytes_.size() - at_) truncated();
    at_ += count;
    return bytes_.substr(at_ - count, count);
  }

  std::size_t take_offset() { return wide_ ? take<std::uint64_t>() : take<std::uint32_t>(); }

  /// Reads a record; false at the empty record that ends a list.
  bool parse_record(FbxRecord& parent, std::size_t parent_end, int depth) {
    const std::size_t begin = at_;
    const std::size_t end = take_offset();
    const std::size_t count = take_offset();
    const std::size_t values_size = take_offset();
    const std::string_view name = take_bytes(take<std::uint8_t>());
    if (end == 0) return false;
    if (end > bytes_.size()) truncated();
    if (end < at_ || end > parent_end || values_size > end - at_ || count > values_size)
      document_.fail("has a record at byte " + std::to_string(begin) + " of sizes that do not fit", "an FBX file");
    if (depth > deepest_record)
      document_.fail("has records deeper than " + std::to_string(deepest_record) + " levels", "an FBX file");
    FbxRecord record;
    record.name = name;
    record.place = begin;
    const std::size_t values_end = at_ + values_size;
    for (std::size_t i = 0; i < count; ++i) {
      record.values.push_back(parse_value(begin));
      if (at_ > values_end)
        document_.fail("has a record at byte " + std::to_string(begin) + " whose values do not fit", "an FBX file");
    }
    at_ = values_end;
    while (at_ < end && parse_record(record, end, depth + 1)) {
    }
    at_ = end;
    parent.children.push_back(std::move(record));
    return true;
  }

  FbxValue parse_value(std::size_t record) {
    FbxValue value;
    value.type = take<char>();
    switch (value.type) {
      case 'Y':
        return whole(take<std::int16_t>());
      case 'B':
      case 'C':
        return whole(take<std::uint8_t>());
      case 'I':
        return whole(take<std::int32_t>());
      case 'L':
        return whole(take<std::int64_t>());
      case 'F':
        return number(static_cast<double>(take<float>()));
      case 'D':
        return number(take<double>());
      case 'S':
      case 'R':
        value.bytes = take_bytes(take<std::uint32_t>());
        return value;
      case 'b':
      case 'c':
      case 'i':
      case 'l':
      case 'f':
      case 'd': {
        value.length = take<std::uint32_t>();
        value.is_packed = take<std::uint32_t>() != 0;
        value.bytes = take_bytes(take<std::uint32_t>());
        return value;
      }
      default:
        document_.fail("has a record at byte " + std::to_string(record) + " with a value of an unknown kind",
                       "an FBX file");
    }
  }

  static FbxValue whole(std::int64_t whole) { return {'L', whole, static_cast<double>(whole), {}, 0, false}; }
  static FbxValue number(double number) { return {'D', 0, number, {}, 0, false}; }

  const FbxDocument& document_;
  std::string_view bytes_;
  bool wide_;
  std::size_t at_ = 0;
};

std::size_t size_of_number(char type) {
  switch (type) {
    case 'b':
      return 1;
    case 'i':
    case 'f':
      return 4;
    default:
      return 8;
  }
}

double plain_number(char type, std::string_view bytes, std::size_t at) {
  switch (type) {
    case 'b':
      return static_cast<unsigned char>(bytes[at]);
    case 'i':
      return read_at<std::int32_t>(bytes, at);
    case 'l':
      return static_cast<double>(read_at<std::int64_t>(bytes, at));
    case 'f':
      return static_cast<double>(read_at<float>(bytes, at));
    default:
      return read_at<double>(bytes, at);
  }
}

/// Calls `take` with every word between commas; false where one is empty.
template <class Take>
bool for_each_item(std::string_view text, const Take& take) {
  if (trimmed(text).empty()) return true;
  while (true) {
    const std::size_t comma = text.find(',');
    std::string_view item = text.substr(0, comma);
    const std::size_t begin = item.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos) return false;
    item = item.substr(begin, item.find_last_not_of(" \t\r\n") + 1 - begin);
    if (!take(item)) return false;
    if (comma == std::string_view::npos) return true;
    text.remove_prefix(comma + 1);
  }
}

}  // namespace

const FbxRecord* FbxRecord::child(std::string_view child_name) const {
  for (const FbxRecord& record : children)
    if (record.name == child_name) return &record;
  return nullptr;
}

std::string_view FbxRecord::text(std::size_t value) const {
  const bool is_text = value < values.size() && std::string_view("SRW").find(values[value].type) != std::string::npos;
  return is_text ? values[value].bytes : std::string_view();
}

std::optional<double> FbxRecord::number(std::size_t value) const {
  const bool is_number = value < values.size() && (values[value].type == 'L' || values[value].type == 'D');
  return is_number && std::isfinite(values[value].number) ? std::optional(values[value].number) : std::nullopt;
}

std::optional<std::int64_t> FbxRecord::whole(std::size_t value) const {
  return value < values.size() && values[value].type == 'L' ? std::optional(values[value].whole) : std::nullopt;
}

FbxDocument::FbxDocument(const std::filesystem::path& file) : file_(file), bytes_(read_text(file)) {
  if (bytes_.empty()) fail("is empty", "an FBX file");
  is_binary_ = std::string_view(bytes_).starts_with(binary_magic);
  if (is_binary_)
    parse_binary();
  else
    parse_text();
}

void FbxDocument::parse_binary() {
  if (bytes_.size() < fbx_header_size)
    fail("is truncated: it ends within its header", "a whole FBX file", "copy it again");
  const auto version = read_at<std::uint32_t>(bytes_, 23);
  if (version < 7000 || version >= 8000)
    fail("is FBX of version " + std::to_string(version), "version 7000 to 7999", "export it as FBX 2011 or later");
  BinaryParser(*this, bytes_).parse(root_);
}

void FbxDocument::parse_text() {
  const std::string remedy = "export it as FBX 2011 or later";
  if (bytes_.starts_with("Kaydara FBX Binary"))
    fail("is a binary FBX file with a damaged header, as of one copied as text", "a whole FBX file", "copy it again");
  const std::size_t begin = bytes_.find_first_not_of(" \t\r\n");
  if (begin == std::string::npos || (bytes_[begin] != ';' && bytes_.find("FBXHeaderExtension") == std::string::npos))
    fail("is no FBX file", "one, binary or as text", remedy);
  parse_fbx_text(*this, bytes_, root_);
  const FbxRecord* header = root_.child("FBXHeaderExtension");
  const FbxRecord* version = header == nullptr ? nullptr : header->child("FBXVersion");
  const std::int64_t number = version == nullptr ? 0 : version->whole(0).value_or(0);
  if (version == nullptr) fail("is no FBX file: it has no FBXVersion", "an FBX file", remedy);
  if (number < 7000 || number >= 8000)
    fail("is FBX of version " + std::to_string(number), "version 7000 to 7999", remedy);
}

void FbxDocument::fail(const std::string& found, const std::string& expected, const std::string& remedy) const {
  throw BadInput(file_.string(), found, expected, remedy);
}

std::string FbxDocument::place_of(const FbxRecord& record) const {
  return (is_binary_ ? "byte " : "line ") + std::to_string(record.place);
}

std::string FbxDocument::unpacked(const FbxRecord& record) const {
  const FbxValue& array = record.values.front();
  const std::size_t size = array.length * size_of_number(array.type);
  const std::string name(record.name);
  const auto broken = [&]() {
    fail(name + " at " + place_of(record) + " does not hold the " + std::to_string(array.length) +
             " numbers that it announces",
         "a whole array");
  };
  if (!array.is_packed) {
    if (array.bytes.size() != size) broken();
    return std::string(array.bytes);
  }
  // Deflate expands a byte to 1032 at most.
  if (size / 1032 > array.bytes.size()) broken();
  std::string result(size, '\0');
  uLongf written = size;
  const int status = uncompress(reinterpret_cast<Bytef*>(result.data()), &written,
                                reinterpret_cast<const Bytef*>(array.bytes.data()), array.bytes.size());
  if (size != 0 && (status != Z_OK || written != size)) broken();
  return result;
}

std::vector<double> FbxDocument::numbers(const FbxRecord& record) const {
  std::vector<double> result;
  if (record.values.empty() || !record.values.front().is_array())
    fail(std::string(record.name) + " at " + place_of(record) + " is no array", "one");
  const FbxValue& array = record.values.front();
  if (array.type == 'a') {
    const bool is_list = for_each_item(array.bytes, [&](std::string_view item) {
      const std::optional<double> number = parse_number(item);
      if (number) result.push_back(*number);
      return number.has_value();
    });
    if (!is_list || result.size() != array.length)
      fail(std::string(record.name) + " at " + place_of(record) + " does not hold the " + std::to_string(array.length) +
               " numbers that it announces",
           "numbers between commas");
    return result;
  }
  const std::string bytes = unpacked(record);
  const std::size_t size = size_of_number(array.type);
  result.reserve(array.length);
  for (std::size_t i = 0; i < array.length; ++i) result.push_back(plain_number(array.type, bytes, i * size));
  return result;
}

std::vector<std::int64_t> FbxDocument::wholes(const FbxRecord& record) const {
  constexpr double most = 9007199254740992.0;  // 2^53
  std::vector<std::int64_t> result;
  for (const double number : numbers(record)) {
    if (!(std::abs(number) <= most) || number != std::floor(number))
      fail(std::string(record.name) + " at " + place_of(record) + " holds a number that is not whole", "whole numbers");
    result.push_back(static_cast<std::int64_t>(number));
  }
  return result;
}

bool FbxDocument::holds_floats(const FbxRecord& record, const std::vector<double>& numbers) const {
  // Text files have 15 digits.
  const double tolerance = record.values.front().type == 'a' ? 1e-14 : 0;
  return std::all_of(numbers.begin(), numbers.end(), [tolerance](double number) {
    const auto rounded = std::abs(number) <= 3e38 ? static_cast<double>(static_cast<float>(number)) : number;
    return std::abs(rounded - number) <= tolerance * std::abs(number);
  });
}

}  // namespace kiln
