#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "import/gltf_document.h"

namespace kiln {

/// Elements of a glTF file: count of them, each of `components` numbers. Refers to bytes that GltfBuffers keeps.
class GltfAccessor {
 public:
  enum class Type { int8 = 5120, uint8 = 5121, int16 = 5122, uint16 = 5123, uint32 = 5125, float32 = 5126 };

  /// Elements that stand in place of those of the bytes (sparse).
  struct Replacements {
    std::vector<std::uint32_t> elements;  ///< rising
    std::span<const std::uint8_t> values;
  };

  std::size_t count = 0;
  int components = 1;
  Type type = Type::float32;
  bool normalized = false;
  const std::uint8_t* bytes = nullptr;  ///< null: zeros
  std::size_t stride = 0;
  std::shared_ptr<const Replacements> replacements;
  std::shared_ptr<const std::vector<double>>
      decoded;  ///< count * components numbers of a Draco mesh, in place of bytes

  /// A number as glTF means it: integers that are normalised are 0 to 1 or -1 to 1.
  double value(std::size_t element, int component) const;

  /// An integer as it is stored.
  std::uint32_t integer(std::size_t element) const;

 private:
  const std::uint8_t* find(std::size_t element) const;
};

/// Bytes of one component.
std::size_t size_of(GltfAccessor::Type type);

/// The text of a URI without its percent signs: "my%20scan.bin" is "my scan.bin".
std::string percent_decoded(std::string_view text);

/// The bytes of a "data:" URI. Nothing where it is none, or is none of base64.
std::optional<std::vector<std::uint8_t>> data_uri_bytes(std::string_view uri);

/// The buffers of a glTF file, read when they are needed: the binary chunk, data URIs, files beside it and what
/// EXT_meshopt_compression packed. Spans and accessors stay good as long as this lives.
class GltfBuffers {
 public:
  explicit GltfBuffers(const GltfDocument& document) : document_(document) {}
  GltfBuffers(const GltfBuffers&) = delete;
  GltfBuffers& operator=(const GltfBuffers&) = delete;

  /// Throws BadInput where there is no such view or its bytes are not all there. `user` names what asks for it.
  std::span<const std::uint8_t> view(std::size_t index, const std::string& user);

  /// Throws BadInput where there is no such accessor or it reaches beyond its view.
  GltfAccessor accessor(std::size_t index, const std::string& user);

  /// What an accessor says of itself, without its bytes.
  GltfAccessor description(std::size_t index, const std::string& user) const;

  /// The files that were read.
  const std::vector<std::filesystem::path>& files() const { return files_; }

  /// Bytes of the file and of those read so far.
  std::size_t total_bytes() const { return document_.file_size() + read_bytes_; }

  /// How many triangles they can mean in earnest, copies counted: a file that names one mesh again and again, to no end
  /// but to take all the memory, has more.
  std::size_t most_triangles() const { return std::min<std::size_t>(4'000'000 + 8 * total_bytes(), 100'000'000); }

 private:
  std::span<const std::uint8_t> buffer(std::size_t index, const std::string& user);
  std::vector<std::uint8_t> load(const std::string& uri, const std::string& place);
  std::span<const std::uint8_t> range(const GltfDocument::Json& object, const std::string& place);
  const std::vector<std::uint8_t>& unpacked(const GltfDocument::Json& packed, const std::string& place);
  std::shared_ptr<const GltfAccessor::Replacements> replacements(const GltfDocument::Json& sparse,
                                                                 const GltfAccessor& accessor,
                                                                 const std::string& place);

  const GltfDocument& document_;
  std::map<std::size_t, std::vector<std::uint8_t>> buffers_;
  std::map<const GltfDocument::Json*, std::vector<std::uint8_t>> unpacked_;
  std::vector<std::filesystem::path> files_;
  std::size_t read_bytes_ = 0;
};

}  // namespace kiln
