#pragma once

#include "import/import_settings.h"
#include "import/source_mesh.h"
#include "import/triangulate.h"

namespace kiln {

/// Moves places together that were meant to be one: of those on borders of the surface (edges of one triangle, when
/// equal places are one) each comes to lie on the first that is at most the weld's distance away, if that is less than
/// a quarter of every edge that either ends. Places inside the surface stay. Automatic is twice the file's precision,
/// at least what a float of the mesh's size resolves, at most a millionth of that size.  Returns how many places were
/// moved.
int weld_borders(SourceMesh& source, const std::vector<CutTriangle>& triangles, const WeldChoice& choice);

}  // namespace kiln
