// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "import/import_mesh.h"
#include "mesh/draco_file.h"
#include "mesh/triangle_mesh.h"
#include "simplify/feature_edges.h"
#include "simplify/simplify_settings.h"
#include "simplify/small_components.h"

namespace kiln {

/// Materials of a mesh by vertex, where vertices are split at the borders of materials.
struct VertexMaterials {
  std::vector<std::uint16_t> of_vertex;  ///< entries of `names`; empty where materials are not kept
  std::vector<std::string> names;        ///< as the file has them; the last is empty where faces have no material

  /// Returns the attribute of the low mesh's file: `material`, 16 bits.
  std::vector<IntegerAttribute> attributes() const;
};

/// Finds the edges between triangles of different materials, each once, the smaller vertex first.
std::vector<VertexPair> borders_of_materials(const ImportedMesh& imported);

/// Gives each triangle of a low mesh the material that most of the high surface nearest to it has, and splits vertices
/// between them.
VertexMaterials take_materials(TriangleMesh& low, const ImportedMesh& imported);

/// Input of a simplification that keeps uvs.
struct KeptSurface {
  TriangleMesh mesh;  ///< one normal and one uv per vertex, split at seams, hard edges and borders of materials
  VertexMaterials materials;
  std::vector<std::uint32_t> layers;  ///< by vertex: find_uv_layers
  DroppedComponents dropped;
  std::vector<std::string> warnings;
};

/// Takes from an imported mesh the uvs and, where settings.keep names them, the materials. Warns of borders of textures
/// that are not kept. Throws BadInput where a corner has no uv, for materials that cannot be read, and for more than
/// 65,536 of them.
KeptSurface kept_surface(const ImportedMesh& imported, const SimplifySettings& settings);

}  // namespace kiln
