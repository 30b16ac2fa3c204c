// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Triangle of a file that a triangle of an atlas was made of, and the corners of it that the other's are.
struct LowTriangle {
  std::uint32_t triangle = 0;
  std::array<std::uint8_t, 3> corners = {0, 1, 2};
};

/// Finds, for every triangle of an atlas, the triangle of `low`, its file as import_mesh reads it into the atlas's
/// frame, that it was made of: Draco changes the order of triangles, and rounds their corners to 16 bits or more, once
/// in each file on the way. Throws BadInput, which names both files, where one is of no triangle.
std::vector<LowTriangle> find_low_triangles(const TriangleMesh& atlas, const TriangleMesh& low,
                                            const std::filesystem::path& low_file);

}  // namespace kiln
