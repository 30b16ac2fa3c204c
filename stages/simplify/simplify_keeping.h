// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "simplify/kept_surface.h"
#include "simplify/simplify.h"

namespace kiln {

/// Writer of the result with its materials: as WrittenForm.
using WrittenWithMaterials = std::function<TriangleMesh(const TriangleMesh&, const VertexMaterials&)>;

/// Simplified mesh, and the materials that were kept.
struct KeepingResult {
  SimplifyResult simplified;
  std::vector<std::string> materials;  ///< names, by the number that vertices of the file have
};

/// Simplifies a mesh such that its own textures fit the result: edges collapse into one of their ends, seams of uvs,
/// hard edges, borders of the mesh and of materials along themselves alone, cheapest first by how far that moves what
/// texels show (TextureDeviation). Unless settings.quality is draft, vertices are then moved, and normals turned, to
/// where the deviation is least; uvs stay. Ends at settings.faces, or before a texel would move by more than
/// settings.max_error of the bounding box's diagonal; where outlines of charts allow no more collapses there are more
/// triangles, and `shortfall` says why. Distances are to `imported`, which `surface` was taken from.
KeepingResult simplify_with_uvs(const ImportedMesh& imported, const KeptSurface& surface,
                                const SimplifySettings& settings, const WrittenWithMaterials& written,
                                const ProgressFunction& progress = no_progress);

/// Simplifies as simplify() does, to `shape`, and keeps borders of materials as lines. The result is written once more
/// with its materials.
KeepingResult simplify_with_materials(const ImportedMesh& imported, const SimplifySettings& settings,
                                      const WrittenForm& shape, const WrittenWithMaterials& written,
                                      const ProgressFunction& progress = no_progress);

}  // namespace kiln
