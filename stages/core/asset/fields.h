// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "asset/faults.h"
#include "base/json.h"

namespace kiln {

/// The keys of a JSON object, each fetched with its type and range checked. Faults name the file and the key; without
/// a place to tell of them the first is thrown. Where they are kept, a key at fault reads as the value that each
/// function names.
class Fields {
 public:
  /// `where` is the place of the object in the file, such as "planes[3]"; empty: the whole. The object, and `faults`,
  /// must outlive these fields.
  Fields(std::string file, std::string where, const Json& object, std::string remedy, Faults* faults = nullptr);

  /// An object of the same file, under `key` or, with an index, in the list there.
  Fields child(const char* key, const Json& object) const;
  Fields child(const char* key, std::size_t index, const Json& object) const;

  bool has(const char* key) const { return object_.is_object() && object_.contains(key); }

  /// Null where the key is not there, which is a fault.
  const Json* find(const char* key, const std::string& expected) const;

  /// `otherwise` where it is at fault.
  int integer(const char* key, int lowest, int highest, int otherwise = 0) const;

  /// 8 or 16; 8 where it is at fault.
  int bits(const char* key) const;

  /// A number that a float can hold; no number (NaN) where it is at fault.
  double number(const char* key) const;

  /// Text; empty where it is at fault.
  std::string text(const char* key, const std::string& expected) const;

  /// Tells of a fault unless the text is `expected`.
  void constant(const char* key, const std::string& expected) const;

  /// A path that stays inside the folder of the file; empty where it is at fault.
  std::string safe_path(const char* key) const;

  /// The list under `key`, of `count` entries, any number of them where that is nothing; null where it is at fault.
  const Json* list(const char* key, std::optional<std::size_t> count, const std::string& what) const;

  /// The list of `count` finite numbers under `key`; empty where it is at fault.
  std::vector<double> numbers(const char* key, std::size_t count) const;

  /// Tells that `what` is `found`.
  void fail(const std::string& what, const std::string& found, const std::string& expected) const;

  void tell(const BadInput& fault) const;

  const std::string& file() const { return file_; }
  const std::string& remedy() const { return remedy_; }

  std::string path(const char* key) const { return where_.empty() ? key : where_ + "." + key; }

  /// JSON text of a value for a message, cut where it is long.
  static std::string shown(const Json& value);

 private:
  std::string file_;
  std::string where_;
  std::string remedy_;
  const Json& object_;
  Faults* faults_;
};

/// Whether a value is a number that is finite as a float.
bool is_finite_float(const Json& value);

/// Throws BadInput where `file` is no whole JSON; `writer` is the program that writes such files.
Json parse_json(const std::filesystem::path& file, const std::string& writer, const std::string& remedy);

}  // namespace kiln
