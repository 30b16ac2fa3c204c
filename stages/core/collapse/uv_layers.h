// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Gives every vertex of a mesh with uvs the layer of its chart: charts of one layer lie beside each other, as charts
/// of one texture do; mirrored and stacked ones get layers of their own, and so do those of different `pictures` (by
/// vertex; empty: all of one). Overlaps are found at 512 x 512 places of the box of all uvs.
std::vector<std::uint32_t> find_uv_layers(const TriangleMesh& mesh, std::span<const std::uint32_t> pictures = {});

}  // namespace kiln
