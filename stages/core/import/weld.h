// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "import/import_settings.h"
#include "import/source_mesh.h"
#include "import/triangulate.h"

namespace kiln {

/// Welds positions on borders of the surface (edges of one triangle, once equal positions are one): each moves onto the
/// first that is at most the weld's distance away, if that is less than a quarter of every edge at either. Positions
/// inside the surface do not move. The automatic distance is twice the file's precision, at least what a float of the
/// mesh's size resolves, at most a millionth of that size. Returns how many positions were moved.
int weld_borders(SourceMesh& source, const std::vector<CutTriangle>& triangles, const WeldChoice& choice);

}  // namespace kiln
