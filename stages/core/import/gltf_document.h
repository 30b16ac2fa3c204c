#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kiln {

/// The JSON of a glTF 2.0 file, looked at with care: whatever is asked of it is there and of its type, or BadInput
/// names the place, such as "accessor 3" or "mesh 2, primitive 0", which callers give.
class GltfDocument {
 public:
  using Json = nlohmann::json;

  /// Reads a .gltf or .glb file, told apart by its first bytes. Throws BadInput for other files and versions, and where
  /// the file requires an extension that is not known.
  explicit GltfDocument(const std::filesystem::path& file);

  const std::filesystem::path& file() const { return file_; }
  std::size_t file_size() const { return bytes_.size(); }

  /// The binary chunk of a .glb; empty where there is none.
  std::span<const std::uint8_t> binary_chunk() const { return binary_; }

  [[noreturn]] void fail(const std::string& found, const std::string& expected,
                         const std::string& remedy = "export it again") const;

  /// How many elements an array of the root, such as "meshes", has.
  std::size_t count(const char* array) const;

  /// An element of such an array, which is an object. `user` names what refers to it, for messages.
  const Json& element(const char* array, std::size_t index, const std::string& user) const;

  /// The root itself.
  const Json& root_object() const { return json_; }

  // Members of `object`, which `place` names for messages. Absent ones are null, nothing or empty.
  const Json* object(const Json& object, const char* key, const std::string& place) const;
  const Json& array(const Json& object, const char* key, const std::string& place) const;
  const Json* extension(const Json& object, const char* name, const std::string& place) const;
  std::optional<std::size_t> index(const Json& object, const char* key, const std::string& place) const;
  std::size_t required_index(const Json& object, const char* key, const std::string& place) const;
  bool flag(const Json& object, const char* key, const std::string& place) const;
  double number(const Json& object, const char* key, double absent, const std::string& place) const;
  std::string text(const Json& object, const char* key, const std::string& place) const;

  /// Finite numbers; as many as `count` where that is not 0.
  std::vector<double> numbers(const Json& object, const char* key, std::size_t count, const std::string& place) const;

  /// The whole numbers of an array.
  std::vector<std::size_t> indices(const Json& object, const char* key, const std::string& place) const;

  /// The extensions that the file uses and that say nothing to Kiln, in the file's order.
  const std::vector<std::string>& unused_extensions() const { return unused_extensions_; }

 private:
  void split_chunks();
  void parse(std::string_view text);
  void check_version() const;
  void check_extensions();
  std::size_t whole(const Json& value, const std::string& place) const;

  std::filesystem::path file_;
  std::string bytes_;
  std::string_view text_;
  std::span<const std::uint8_t> binary_;
  Json json_;
  std::vector<std::string> unused_extensions_;
};

}  // namespace kiln
