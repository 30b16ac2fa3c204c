// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "bake/scene/receiver_set.h"
#include "import/import_settings.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Vertices of a mesh as receivers.
struct VertexReceivers {
  /// One receiver for each vertex, along a space-filling curve.
  ReceiverSet receivers;
  double largest_distance = 0;  ///< largest distance of a vertex from its receiver, object units
  std::size_t facing_away = 0;  ///< vertices for which that surface has no point near them that faces as they do
};

/// Loads a mesh whose vertices are to receive light, as import_mesh does, in a frame of its own, one vertex for each
/// normal at a place; a Draco file keeps the vertices, normals and uvs it has. Every vertex is in a triangle of three
/// different ones. `warnings`, if given, get those of import_mesh. Throws BadInput.
TriangleMesh load_vertex_mesh(const std::filesystem::path& file, const ImportSettings& settings = {},
                              std::vector<std::string>* warnings = nullptr);

/// Returns receivers on the mesh itself, with its normals, which it must have.
VertexReceivers receivers_on_vertices(const TriangleMesh& mesh);

/// Returns receivers at the closest point of `high` (with normals, at least one triangle) that faces as the vertex
/// does, with the high mesh's normal there. Where there is none within four times the distance that any vertex has from
/// `high`, at the closest point of either side.
VertexReceivers receivers_on_high_of_vertices(const TriangleMesh& mesh, const TriangleMesh& high);

}  // namespace kiln
