// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/gltf_document.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string_view>

#include "base/errors.h"
#include "base/files.h"

// The format is glTF 2.0 [Khronos 2021], with the binary form of its chapter 4. The JSON is checked here rather than by
// tinygltf 2.7, which refuses the buffers without bytes of EXT_meshopt_compression, and leaves the checks of indices
// and sizes to its caller.

namespace kiln {

namespace {

constexpr std::string_view magic = "glTF";
constexpr std::uint32_t json_chunk = 0x4E4F534A, binary_chunk_type = 0x004E4942;
constexpr int deepest_json = 100;  // levels; glTF itself needs about ten

/// Extensions that are read, or that do not affect shape and colour beyond what the plain file says.
constexpr std::array known_extensions = {
    "KHR_draco_mesh_compression",
    "EXT_meshopt_compression",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_texture_basisu",
    "EXT_texture_webp",
    "MSFT_texture_dds",
    "EXT_mesh_gpu_instancing",
};

std::uint32_t word_at(std::string_view bytes, std::size_t offset) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + offset, sizeof word);
  return word;
}

}  // namespace

GltfDocument::GltfDocument(const std::filesystem::path& file) : file_(file), bytes_(read_text(file)) {
  if (bytes_.empty()) fail("is empty", "a glTF file");
  if (std::string_view(bytes_).starts_with(magic))
    split_chunks();
  else
    text_ = bytes_;
  parse(text_);
  check_version();
  check_extensions();
}

void GltfDocument::fail(const std::string& found, const std::string& expected, const std::string& remedy) const {
  throw BadInput(file_.string(), found, expected, remedy);
}

void GltfDocument::split_chunks() {
  const std::string_view bytes = bytes_;
  if (bytes.size() < 20) fail("is truncated: it ends within its header", "a binary glTF file", "copy it again");
  if (const std::uint32_t version = word_at(bytes, 4); version != 2)
    fail("is a binary glTF file of version " + std::to_string(version), "version 2", "export it as glTF 2.0");
  if (const std::size_t length = word_at(bytes, 8); length > bytes.size())
    fail("is truncated: it has " + std::to_string(bytes.size()) + " of the " + std::to_string(length) +
             " bytes that it announces",
         "a whole file", "copy it again");
  bool has_text = false, has_binary = false;
  for (std::size_t at = 12; at + 8 <= bytes.size();) {
    const std::size_t size = word_at(bytes, at);
    const std::uint32_t type = word_at(bytes, at + 4);
    at += 8;
    if (size > bytes.size() - at)
      fail("is truncated: a chunk of " + std::to_string(size) + " bytes at byte " + std::to_string(at) +
               " reaches beyond the file's end",
           "a whole file", "copy it again");
    if (type == json_chunk && !has_text) {
      text_ = bytes.substr(at, size);
      has_text = true;
    } else if (type == binary_chunk_type && !has_binary) {
      binary_ = {reinterpret_cast<const std::uint8_t*>(bytes.data()) + at, size};
      has_binary = true;
    }
    at += size;
  }
  if (!has_text) fail("has no JSON chunk", "a binary glTF file, which begins with one");
}

void GltfDocument::parse(std::string_view text) {
  while (!text.empty() && text.back() == '\0') text.remove_suffix(1);  // wrong padding by exporters
  // Excessive nesting takes memory out of proportion: end the parse.
  const auto limit_depth = [this](int depth, GltfJson::parse_event_t, GltfJson&) {
    if (depth > deepest_json) fail("is nested deeper than " + std::to_string(deepest_json) + " levels", "glTF's JSON");
    return true;
  };
  try {
    json_ = GltfJson::parse(text, limit_depth);
  } catch (const GltfJson::parse_error& fault) {
    if (fault.byte > text.size())
      fail("is truncated: its JSON ends too early, at byte " + std::to_string(text.size()), "a whole glTF file",
           "copy it again");
    fail("is no JSON at byte " + std::to_string(fault.byte) + " of it", "a glTF file");
  } catch (const GltfJson::exception& fault) {
    fail(std::string("has JSON that cannot be read (") + fault.what() + ")", "a glTF file");
  }
  if (!json_.is_object()) fail("holds JSON that is no object", "a glTF file");
}

void GltfDocument::check_version() const {
  const GltfJson* asset = object(json_, "asset", "the file");
  if (asset == nullptr) fail("has no \"asset\", so it is no glTF file", "a glTF 2.0 file");
  const std::string version = text(*asset, "version", "asset");
  const std::string needed = text(*asset, "minVersion", "asset");
  if (!version.starts_with("2.") || (!needed.empty() && needed != "2.0"))
    fail("is glTF of version '" + (needed.empty() ? version : needed) + "'", "version 2.0", "export it as glTF 2.0");
}

void GltfDocument::check_extensions() {
  const auto is_known = [](const std::string& name) {
    return std::find(known_extensions.begin(), known_extensions.end(), name) != known_extensions.end();
  };
  const auto names = [this](const char* key) {
    std::vector<std::string> result;
    for (const GltfJson& name : array(json_, key, "the file")) {
      if (!name.is_string()) fail(std::string(key) + " holds something that is no name", "names of extensions");
      if (const auto& known = name.get_ref<const std::string&>();
          std::find(result.begin(), result.end(), known) == result.end())
        result.push_back(known);
    }
    return result;
  };
  for (const std::string& name : names("extensionsRequired"))
    if (!is_known(name) && !name.starts_with("KHR_materials_"))  // how light is reflected, not how much
      fail("requires the extension " + name, "extensions that Kiln knows", "export it without " + name);
  for (std::string& name : names("extensionsUsed"))
    if (!is_known(name)) unused_extensions_.push_back(std::move(name));
}

std::size_t GltfDocument::count(const char* array_name) const { return array(json_, array_name, "the file").size(); }

const GltfJson& GltfDocument::element(const char* array_name, std::size_t index, const std::string& user) const {
  const GltfJson& elements = array(json_, array_name, "the file");
  if (index >= elements.size())
    fail(user + " refers to element " + std::to_string(index) + " of \"" + array_name + "\"",
         "one of the " + std::to_string(elements.size()) + " that there are, counted from 0");
  if (!elements[index].is_object())
    fail("element " + std::to_string(index) + " of \"" + array_name + "\" is no JSON object", "an object");
  return elements[index];
}

const GltfJson* GltfDocument::object(const GltfJson& object, const char* key, const std::string& place) const {
  const auto found = object.find(key);
  if (found == object.end()) return nullptr;
  if (!found->is_object()) fail("\"" + std::string(key) + "\" of " + place + " is no JSON object", "an object");
  return &*found;
}

const GltfJson& GltfDocument::array(const GltfJson& object, const char* key, const std::string& place) const {
  static const GltfJson none = GltfJson::array();
  const auto found = object.find(key);
  if (found == object.end()) return none;
  if (!found->is_array()) fail("\"" + std::string(key) + "\" of " + place + " is no JSON array", "an array");
  return *found;
}

const GltfJson* GltfDocument::extension(const GltfJson& holder, const char* name, const std::string& place) const {
  const GltfJson* extensions = object(holder, "extensions", place);
  return extensions == nullptr ? nullptr : object(*extensions, name, place);
}

std::size_t GltfDocument::whole(const GltfJson& value, const std::string& place) const {
  constexpr double largest = 9007199254740992.0;  // 2^53
  const double number = value.is_number() ? value.get<double>() : -1;
  if (!(number >= 0 && number <= largest) || number != std::floor(number))
    fail(place + " is no whole number of 0 or more", "one");
  return static_cast<std::size_t>(number);
}

std::optional<std::size_t> GltfDocument::index(const GltfJson& object, const char* key,
                                               const std::string& place) const {
  const auto found = object.find(key);
  if (found == object.end()) return std::nullopt;
  return whole(*found, "\"" + std::string(key) + "\" of " + place);
}

std::size_t GltfDocument::required_index(const GltfJson& object, const char* key, const std::string& place) const {
  const std::optional<std::size_t> found = index(object, key, place);
  if (!found) fail(place + " has no \"" + key + "\"", "one");
  return *found;
}

bool GltfDocument::flag(const GltfJson& object, const char* key, const std::string& place) const {
  const auto found = object.find(key);
  if (found == object.end()) return false;
  if (!found->is_boolean())
    fail("\"" + std::string(key) + "\" of " + place + " is neither true nor false", "a boolean");
  return found->get<bool>();
}

double GltfDocument::number(const GltfJson& object, const char* key, double absent, const std::string& place) const {
  const auto found = object.find(key);
  if (found == object.end()) return absent;
  if (!found->is_number() || !std::isfinite(found->get<double>()))
    fail("\"" + std::string(key) + "\" of " + place + " is no number", "one");
  return found->get<double>();
}

std::string GltfDocument::text(const GltfJson& object, const char* key, const std::string& place) const {
  const auto found = object.find(key);
  if (found == object.end()) return {};
  if (!found->is_string()) fail("\"" + std::string(key) + "\" of " + place + " is no text", "a string");
  return found->get<std::string>();
}

std::vector<double> GltfDocument::numbers(const GltfJson& object, const char* key, std::size_t count,
                                          const std::string& place) const {
  std::vector<double> result;
  if (!object.contains(key)) return result;
  const std::string name = "\"" + std::string(key) + "\" of " + place;
  for (const GltfJson& value : array(object, key, place)) {
    if (!value.is_number() || !std::isfinite(value.get<double>()))
      fail(name + " holds something that is no number", "numbers");
    result.push_back(value.get<double>());
  }
  if (count != 0 && result.size() != count)
    fail(name + " has " + std::to_string(result.size()) + " numbers", std::to_string(count));
  return result;
}

std::vector<std::size_t> GltfDocument::indices(const GltfJson& object, const char* key,
                                               const std::string& place) const {
  std::vector<std::size_t> result;
  for (const GltfJson& value : array(object, key, place))
    result.push_back(whole(value, "an entry of \"" + std::string(key) + "\" of " + place));
  return result;
}

}  // namespace kiln
