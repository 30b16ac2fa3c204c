// SPDX-License-Identifier: MIT
#include "asset/fields.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/files.h"
#include "base/json.h"

namespace kiln {

Fields::Fields(std::string file, std::string where, const Json& object, std::string remedy, Faults* faults)
    : file_(std::move(file)), where_(std::move(where)), remedy_(std::move(remedy)), object_(object), faults_(faults) {
  if (!object.is_object()) fail(where_.empty() ? "the file" : where_, shown(object), "a JSON object");
}

Fields Fields::child(const char* key, const Json& object) const { return {file_, path(key), object, remedy_, faults_}; }

Fields Fields::child(const char* key, std::size_t index, const Json& object) const {
  return {file_, path(key) + "[" + std::to_string(index) + "]", object, remedy_, faults_};
}

bool Fields::has(const char* key) const { return object_.is_object() && object_.contains(key); }

const Json* Fields::find(const char* key, const std::string& expected) const {
  if (has(key)) return &object_[key];
  // A value that is no object has been reported already.
  if (object_.is_object()) tell(BadInput(file_, "has no " + path(key), expected, remedy_));
  return nullptr;
}

int Fields::integer(const char* key, int lowest, int highest, int otherwise) const {
  const std::string expected = "a whole number of " + std::to_string(lowest) + " to " + std::to_string(highest);
  const Json* value = find(key, expected);
  if (value == nullptr) return otherwise;
  const bool fits = value->is_number_unsigned() ? value->get<std::uint64_t>() <= static_cast<std::uint64_t>(highest)
                                                : value->is_number_integer() && value->get<std::int64_t>() <= highest;
  if (fits && value->get<std::int64_t>() >= lowest) return value->get<int>();
  fail(path(key), shown(*value), expected);
  return otherwise;
}

int Fields::bits(const char* key) const {
  const int found = integer(key, 8, 16, 8);
  if (found == 8 || found == 16) return found;
  fail(path(key), std::to_string(found), "8 or 16");
  return 8;
}

double Fields::number(const char* key) const {
  const std::string expected = "a finite number";
  const Json* value = find(key, expected);
  if (value != nullptr && is_finite_float(*value)) return value->get<double>();
  if (value != nullptr) fail(path(key), shown(*value), expected);
  return std::numeric_limits<double>::quiet_NaN();
}

std::string Fields::text(const char* key, const std::string& expected) const {
  const Json* value = find(key, expected);
  if (value == nullptr) return "";
  if (value->is_string()) return value->get<std::string>();
  fail(path(key), shown(*value), expected);
  return "";
}

void Fields::constant(const char* key, const std::string& expected) const {
  const Json* value = find(key, expected);
  if (value != nullptr && *value != expected) fail(path(key), shown(*value), expected);
}

std::string Fields::safe_path(const char* key) const {
  const std::string expected = "the path of a file inside the folder, relative to it";
  const Json* value = find(key, expected);
  if (value == nullptr) return "";
  const std::string found = value->is_string() ? value->get<std::string>() : "";
  const std::filesystem::path as_path(found);
  const bool odd = found.empty() || std::any_of(found.begin(), found.end(), [](unsigned char c) { return c < 32; });
  const bool outside = as_path.is_absolute() || std::find(as_path.begin(), as_path.end(), "..") != as_path.end();
  if (!odd && !outside) return found;
  fail(path(key), shown(*value), expected);
  return "";
}

const Json* Fields::list(const char* key, std::optional<std::size_t> count, const std::string& what) const {
  const std::string expected = "a list of " + (count ? std::to_string(*count) + " " : "") + what;
  const Json* value = find(key, expected);
  if (value == nullptr) return nullptr;
  if (!value->is_array())
    fail(path(key), "no list", expected);
  else if (count && value->size() != *count)
    fail(path(key), "a list of " + std::to_string(value->size()), expected);
  else
    return value;
  return nullptr;
}

std::vector<double> Fields::numbers(const char* key, std::size_t count) const {
  const Json* value = list(key, count, "numbers");
  if (value == nullptr) return {};
  if (std::all_of(value->begin(), value->end(), is_finite_float)) return value->get<std::vector<double>>();
  fail(path(key), shown(*value), std::to_string(count) + " finite numbers");
  return {};
}

void Fields::fail(const std::string& what, const std::string& found, const std::string& expected) const {
  tell(BadInput(file_, what + " is " + found, expected, remedy_));
}

void Fields::tell(const BadInput& fault) const {
  if (faults_ == nullptr) throw fault;
  faults_->tell(fault);
}

std::string Fields::shown(const Json& value) {
  std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  constexpr std::size_t longest = 60;
  return text.size() <= longest ? text : text.substr(0, longest) + "...";
}

bool is_finite_float(const Json& value) { return value.is_number() && std::isfinite(value.get<float>()); }

Json parse_json(const std::filesystem::path& file, const std::string& writer, const std::string& remedy) {
  try {
    return Json::parse(read_text(file));
  } catch (const Json::exception&) {
    throw BadInput(file.string(), "is no whole JSON file", "what " + writer + " writes", remedy);
  }
}

}  // namespace kiln
