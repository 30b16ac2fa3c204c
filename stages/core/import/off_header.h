// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace kiln {

/// Header of an OFF file.
struct OffHeader {
  bool has_uvs = false, has_colors = false, has_normals = false, has_weights = false;
  bool is_binary = false;
  std::uint64_t vertex_count = 0, face_count = 0;  ///< in a binary file they are in its data
  std::size_t size = 0;                            ///< offset of the data, in bytes
  std::uint32_t line = 0;                          ///< line in which the data begins, from 1
};

/// Reads the header of an OFF file, whose whole content is `text`: '[ST][C][N][4]OFF [BINARY]' and the numbers of
/// vertices, faces and, optionally, edges. The keyword may be missing, and the numbers may follow it directly ("OFF8 6
/// 0"). Throws BadInput.
OffHeader read_off_header(const std::string& file, std::string_view text);

}  // namespace kiln
