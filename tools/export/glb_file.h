// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/json.h"

namespace kiln {

/// How a texture is looked up: glTF's numbers for filters. Coordinates are clamped, since outlines of charts may touch
/// the picture's border.
enum class GlbSampler {
  smooth,  ///< bilinear, with mipmaps: pictures that any viewer shows
  exact,   ///< bilinear, without mipmaps: planes
};

/// glTF 2.0 file in one piece (.glb): its JSON, and one buffer of bytes.
/// https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html, chapter 4.
class GlbFile {
 public:
  GlbFile();

  /// Returns the JSON, to which callers add what is no bytes; `buffers`, `bufferViews`, `images`, `textures` and
  /// `samplers` are this class's own.
  Json& json() { return json_; }

  /// Appends an object to the list under `key` of the JSON; returns its number.
  std::size_t add(const char* key, Json object);

  /// Adds bytes as a buffer view, whose other keys are `more`; returns its number.
  std::size_t add_bytes(std::string_view bytes, const Json& more = Json::object());

  /// Adds bytes that are the packed form (EXT_meshopt_compression) of `count` elements of `stride` bytes; `mode` and
  /// `target` as the extension and glTF have them. Returns the number of the buffer view.
  std::size_t add_packed(std::string_view packed, std::size_t count, std::size_t stride, const char* mode, int target);

  /// Adds a PNG, as its bytes are, and a texture of it; returns the texture's number.
  std::size_t add_picture(std::string_view png, const std::string& name, GlbSampler sampler);

  /// Notes that the file uses an extension, and whether readers must know it.
  void use_extension(const std::string& name, bool required);

  /// Returns the whole file.
  std::string bytes() const;

 private:
  std::size_t append(std::string_view bytes);

  Json json_;
  std::string buffer_;
  std::size_t unpacked_bytes_ = 0;  // length of the buffer that packed views stand for, which the file does not hold
  std::vector<std::pair<GlbSampler, std::size_t>> samplers_;
};

}  // namespace kiln
