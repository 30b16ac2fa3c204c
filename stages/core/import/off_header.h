#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace kiln {

/// What the first lines of an OFF file say.
struct OffHeader {
  bool has_uvs = false, has_colors = false, has_normals = false, has_weights = false;
  bool is_binary = false;
  std::uint64_t vertex_count = 0, face_count = 0;  ///< of a binary file they stand in its data
  std::size_t size = 0;                            ///< where the data begins, in bytes
  std::uint32_t line = 0;                          ///< in which the data begins, from 1
};

/// Reads the header of an OFF file, of which `text` is all: '[ST][C][N][4]OFF [BINARY]' and the numbers of vertices,
/// faces and, where it has them, edges. The keyword may be missing, and the numbers may stand behind it ("OFF8 6 0").
/// Throws BadInput.
OffHeader read_off_header(const std::string& file, std::string_view text);

}  // namespace kiln
