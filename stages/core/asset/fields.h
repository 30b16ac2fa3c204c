// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "asset/faults.h"
#include "base/json_fwd.h"

namespace kiln {

/// Keys of a JSON object, each fetched with its type and range checked. Messages name the file and the key. Without
/// `faults` the first fault is thrown; with it faults are collected, and a faulty key reads as the fallback that each
/// function states.
class Fields {
 public:
  /// Wraps `object`, which stands at `where` in the file, such as "planes[3]"; empty for the whole file. `object` and
  /// `faults` must outlive this.
  Fields(std::string file, std::string where, const Json& object, std::string remedy, Faults* faults = nullptr);

  /// Wraps an object of the same file: the value of `key` or, with an index, an entry of the list there.
  Fields child(const char* key, const Json& object) const;
  Fields child(const char* key, std::size_t index, const Json& object) const;

  bool has(const char* key) const;

  /// Returns the value of `key`; null, and a fault, if there is none.
  const Json* find(const char* key, const std::string& expected) const;

  /// Reads a whole number; `otherwise` if faulty.
  int integer(const char* key, int lowest, int highest, int otherwise = 0) const;

  /// Reads a number of bits, 8 or 16; 8 if faulty.
  int bits(const char* key) const;

  /// Reads a number that fits a float; NaN if faulty.
  double number(const char* key) const;

  /// Reads text; empty if faulty.
  std::string text(const char* key, const std::string& expected) const;

  /// Reports a fault unless the text is `expected`.
  void constant(const char* key, const std::string& expected) const;

  /// Reads a path that stays inside the file's folder; empty if faulty.
  std::string safe_path(const char* key) const;

  /// Returns the list under `key`, of `count` entries (of any number without `count`); null if faulty.
  const Json* list(const char* key, std::optional<std::size_t> count, const std::string& what) const;

  /// Reads the list of `count` finite numbers under `key`; empty if faulty.
  std::vector<double> numbers(const char* key, std::size_t count) const;

  /// Reports that `what` is `found` instead of `expected`.
  void fail(const std::string& what, const std::string& found, const std::string& expected) const;

  void tell(const BadInput& fault) const;

  const std::string& file() const { return file_; }
  const std::string& remedy() const { return remedy_; }

  std::string path(const char* key) const { return where_.empty() ? key : where_ + "." + key; }

  /// Formats a value as JSON text for a message, shortened if it is long.
  static std::string shown(const Json& value);

 private:
  std::string file_;
  std::string where_;
  std::string remedy_;
  const Json& object_;
  Faults* faults_;
};

/// Tests whether a value is a number that is finite as a float.
bool is_finite_float(const Json& value);

/// Parses a JSON file. Throws BadInput if `file` is no valid JSON; `writer` is the program that writes such files.
Json parse_json(const std::filesystem::path& file, const std::string& writer, const std::string& remedy);

}  // namespace kiln
