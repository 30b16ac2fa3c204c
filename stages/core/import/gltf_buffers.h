// SPDX-License-Identifier: GPL-3.0-or-later
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

  /// Elements that replace some of those in the bytes (sparse accessors).
  struct Replacements {
    std::vector<std::uint32_t> elements;  ///< ascending
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

  /// Returns a number as glTF means it: normalised integers are 0 to 1 or -1 to 1.
  double value(std::size_t element, int component) const;

  /// Returns an integer as it is stored.
  std::uint32_t integer(std::size_t element) const;

 private:
  const std::uint8_t* find(std::size_t element) const;
};

/// Returns the number of bytes of one component.
std::size_t size_of(GltfAccessor::Type type);

/// Decodes the percent signs of a URI: "my%20scan.bin" becomes "my scan.bin".
std::string percent_decoded(std::string_view text);

/// Returns the bytes of a "data:" URI; nothing for other URIs, and for data that is not base64.
std::optional<std::vector<std::uint8_t>> data_uri_bytes(std::string_view uri);

/// Buffers of a glTF file, read on demand: the binary chunk, data URIs, files beside it, and data packed by
/// EXT_meshopt_compression. Spans and accessors stay valid as long as this object lives.
class GltfBuffers {
 public:
  explicit GltfBuffers(const GltfDocument& document) : document_(document) {}
  GltfBuffers(const GltfBuffers&) = delete;
  GltfBuffers& operator=(const GltfBuffers&) = delete;

  /// Returns the bytes of a view. Throws BadInput where there is no such view or its bytes are incomplete. `user` names
  /// who asks.
  std::span<const std::uint8_t> view(std::size_t index, const std::string& user);

  /// Returns an accessor. Throws BadInput where there is no such accessor or it reaches beyond its view.
  GltfAccessor accessor(std::size_t index, const std::string& user);

  /// Returns the description of an accessor, without its bytes.
  GltfAccessor description(std::size_t index, const std::string& user) const;

  /// Returns the files that were read.
  const std::vector<std::filesystem::path>& files() const { return files_; }

  /// Returns the number of bytes of the file and of those read so far.
  std::size_t total_bytes() const { return document_.file_size() + read_bytes_; }

  /// Returns the largest plausible number of triangles, copies included: a file that repeats one mesh beyond that is
  /// made to take all memory.
  std::size_t most_triangles() const { return std::min<std::size_t>(4'000'000 + 8 * total_bytes(), 100'000'000); }

 private:
  std::span<const std::uint8_t> buffer(std::size_t index, const std::string& user);
  std::vector<std::uint8_t> load(const std::string& uri, const std::string& place);
  std::span<const std::uint8_t> range(const GltfJson& object, const std::string& place);
  const std::vector<std::uint8_t>& unpacked(const GltfJson& packed, const std::string& place);
  std::shared_ptr<const GltfAccessor::Replacements> replacements(const GltfJson& sparse, const GltfAccessor& accessor,
                                                                 const std::string& place);

  const GltfDocument& document_;
  std::map<std::size_t, std::vector<std::uint8_t>> buffers_;
  std::map<const GltfJson*, std::vector<std::uint8_t>> unpacked_;
  std::vector<std::filesystem::path> files_;
  std::size_t read_bytes_ = 0;
};

}  // namespace kiln
