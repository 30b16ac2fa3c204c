// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kiln {

using GltfJson = nlohmann::json;

/// Checked JSON of a glTF 2.0 file: every requested member exists and has its type, or BadInput names the place that
/// the caller gives, such as "accessor 3" or "mesh 2, primitive 0".
class GltfDocument {
 public:
  /// Reads a .gltf or .glb file, distinguished by its first bytes. Throws BadInput for other files and versions, and
  /// where the file requires an unknown extension.
  explicit GltfDocument(const std::filesystem::path& file);

  const std::filesystem::path& file() const { return file_; }
  std::size_t file_size() const { return bytes_.size(); }

  /// Returns the binary chunk of a .glb; empty where there is none.
  std::span<const std::uint8_t> binary_chunk() const { return binary_; }

  [[noreturn]] void fail(const std::string& found, const std::string& expected,
                         const std::string& remedy = "export it again") const;

  /// Counts the elements of an array of the root, such as "meshes".
  std::size_t count(const char* array) const;

  /// Returns an element of such an array, an object. `user` names in messages what refers to it.
  const GltfJson& element(const char* array, std::size_t index, const std::string& user) const;

  /// Returns the root object.
  const GltfJson& root_object() const { return json_; }

  // The functions below return members of `object`, which messages call `place`. Absent ones are null, nothing or
  // empty.
  const GltfJson* object(const GltfJson& object, const char* key, const std::string& place) const;
  const GltfJson& array(const GltfJson& object, const char* key, const std::string& place) const;
  const GltfJson* extension(const GltfJson& object, const char* name, const std::string& place) const;
  std::optional<std::size_t> index(const GltfJson& object, const char* key, const std::string& place) const;
  std::size_t required_index(const GltfJson& object, const char* key, const std::string& place) const;
  bool flag(const GltfJson& object, const char* key, const std::string& place) const;
  double number(const GltfJson& object, const char* key, double absent, const std::string& place) const;
  std::string text(const GltfJson& object, const char* key, const std::string& place) const;

  /// Returns finite numbers; exactly `count` of them where that is not 0.
  std::vector<double> numbers(const GltfJson& object, const char* key, std::size_t count,
                              const std::string& place) const;

  /// Returns the whole numbers of an array.
  std::vector<std::size_t> indices(const GltfJson& object, const char* key, const std::string& place) const;

  /// Returns the extensions that the file uses and Kiln ignores, in the file's order.
  const std::vector<std::string>& unused_extensions() const { return unused_extensions_; }

 private:
  void split_chunks();
  void parse(std::string_view text);
  void check_version() const;
  void check_extensions();
  std::size_t whole(const GltfJson& value, const std::string& place) const;

  std::filesystem::path file_;
  std::string bytes_;
  std::string_view text_;
  std::span<const std::uint8_t> binary_;
  GltfJson json_;
  std::vector<std::string> unused_extensions_;
};

}  // namespace kiln
