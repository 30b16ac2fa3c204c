// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "import/corner_attributes.h"
#include "import/import_settings.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Sets the normals of a repaired mesh as `choice` says, and adds to `warnings` how they differ from the file's: an
/// open part that is wound against the file's normals is turned to face them; a closed part keeps its winding, and its
/// normals are turned; single corners whose normal faces away from their triangle, or is not a direction, get the
/// normal of the faces around. Throws BadInput, which names the file `name`, where its normals are asked for and it has
/// none.
void set_normals(TriangleMesh& mesh, const CornerAttributes& attributes, const NormalChoice& choice,
                 const std::string& name, std::vector<std::string>& warnings);

}  // namespace kiln
