#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "base/errors.h"
#include "base/outputs.h"

namespace kiln {

/// The keys of a JSON object, each fetched with its type and range checked; faults name the file and the key.
class Fields {
 public:
  Fields(std::string file, std::string where, const nlohmann::json& object, std::string remedy)
      : file_(std::move(file)), where_(std::move(where)), remedy_(std::move(remedy)), object_(object) {
    if (!object.is_object()) fail(where_.empty() ? "the file" : where_, shown(object), "a JSON object");
  }

  bool has(const char* key) const { return object_.contains(key); }

  const nlohmann::json& get(const char* key, const std::string& expected) const {
    if (!has(key)) throw BadInput(file_, "has no " + path(key), expected, remedy_);
    return object_[key];
  }

  int integer(const char* key, int lowest, int highest) const {
    const std::string expected = "a whole number of " + std::to_string(lowest) + " to " + std::to_string(highest);
    const nlohmann::json& value = get(key, expected);
    const bool fits = value.is_number_unsigned() ? value.get<std::uint64_t>() <= static_cast<std::uint64_t>(highest)
                                                 : value.is_number_integer() && value.get<std::int64_t>() <= highest;
    if (!fits || value.get<std::int64_t>() < lowest) fail(path(key), shown(value), expected);
    return value.get<int>();
  }

  double number(const char* key) const {
    const std::string expected = "a finite number";
    const nlohmann::json& value = get(key, expected);
    if (!value.is_number() || !std::isfinite(value.get<float>())) fail(path(key), shown(value), expected);
    return value.get<double>();
  }

  std::string text(const char* key, const std::string& expected) const {
    const nlohmann::json& value = get(key, expected);
    if (!value.is_string()) fail(path(key), shown(value), expected);
    return value.get<std::string>();
  }

  void constant(const char* key, const std::string& expected) const {
    if (const std::string found = text(key, expected); found != expected) fail(path(key), shown(found), expected);
  }

  /// A path that stays inside the folder of the file.
  std::string safe_path(const char* key) const {
    const std::string expected = "the path of a file inside the folder, relative to it";
    const std::string found = text(key, expected);
    const std::filesystem::path as_path(found);
    const bool odd = found.empty() || std::any_of(found.begin(), found.end(), [](unsigned char c) { return c < 32; });
    const bool outside = as_path.is_absolute() || std::find(as_path.begin(), as_path.end(), "..") != as_path.end();
    if (odd || outside) fail(path(key), shown(found), expected);
    return found;
  }

  [[noreturn]] void fail(const std::string& what, const std::string& found, const std::string& expected) const {
    throw BadInput(file_, what + " is " + found, expected, remedy_);
  }

  const std::string& file() const { return file_; }

  std::string path(const char* key) const { return where_.empty() ? key : where_ + "." + key; }

 private:
  static std::string shown(const nlohmann::json& value) {
    std::string text = value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
    constexpr std::size_t longest = 60;
    return text.size() <= longest ? text : text.substr(0, longest) + "...";
  }

  std::string file_;
  std::string where_;
  std::string remedy_;
  const nlohmann::json& object_;
};

/// Throws BadInput where `file` is no whole JSON; `writer` is the program that writes such files.
inline nlohmann::json parse_json(const std::filesystem::path& file, const std::string& writer,
                                 const std::string& remedy) {
  try {
    return nlohmann::json::parse(read_text(file));
  } catch (const nlohmann::json::exception&) {
    throw BadInput(file.string(), "is no whole JSON file", "what " + writer + " writes", remedy);
  }
}

}  // namespace kiln
