// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kiln {

/// Value of a record of an FBX file. Refers to the file's bytes.
struct FbxValue {
  /// 'L' whole number, 'D' number, 'S' string, 'R' bytes, 'W' bare word of a text file, and arrays: 'b' and 'c' bytes,
  /// 'i' and 'l' whole numbers of 4 and 8 bytes, 'f' and 'd' numbers of 4 and 8 bytes, 'a' of a text file.
  char type = 'L';
  std::int64_t whole = 0;
  double number = 0;
  std::string_view bytes;    ///< content of strings and arrays, packed or not
  std::uint32_t length = 0;  ///< number of elements of an array
  bool is_packed = false;    ///< the array is compressed by zlib

  bool is_array() const { return std::string_view("bcilfda").find(type) != std::string_view::npos; }
};

/// Record of an FBX file: a name, values, and child records.
struct FbxRecord {
  std::string_view name;
  std::size_t place = 0;  ///< byte in a binary file, line in a text file
  std::vector<FbxValue> values;
  std::vector<FbxRecord> children;

  /// Returns the first child of that name; null where there is none.
  const FbxRecord* child(std::string_view child_name) const;

  /// Return a value as text, or as a number; empty or nothing where it is missing or of another kind.
  std::string_view text(std::size_t value) const;
  std::optional<double> number(std::size_t value) const;
  std::optional<std::int64_t> whole(std::size_t value) const;
};

/// Records of an FBX file of version 7.0 or later, binary or text.
class FbxDocument {
 public:
  /// Reads the file. Throws BadInput for other files.
  explicit FbxDocument(const std::filesystem::path& file);

  const std::filesystem::path& file() const { return file_; }
  std::size_t file_size() const { return bytes_.size(); }
  const FbxRecord& root() const { return root_; }

  [[noreturn]] void fail(const std::string& found, const std::string& expected,
                         const std::string& remedy = "export it again") const;

  /// Returns the place of a record for messages: "line 12" or "byte 3456".
  std::string place_of(const FbxRecord& record) const;

  /// Returns the numbers of the array that is the first value of `record`. Throws BadInput where it is none or is
  /// damaged.
  std::vector<double> numbers(const FbxRecord& record) const;
  std::vector<std::int64_t> wholes(const FbxRecord& record) const;

  /// Tells whether an array holds former floats: all its numbers, as written, fit floats.
  bool holds_floats(const FbxRecord& record, const std::vector<double>& numbers) const;

 private:
  void parse_binary();
  void parse_text();
  std::string unpacked(const FbxRecord& record) const;

  std::filesystem::path file_;
  std::string bytes_;
  bool is_binary_ = false;
  FbxRecord root_;
};

}  // namespace kiln
