// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "import/source_mesh.h"

namespace kiln {

/// Gives the faces of a mesh materials by their colours, one per colour, in the order of first use. `colors` are as
/// many as faces, 0 to 1; faces without a colour have values that are not finite. More than 65,536 colours are rounded
/// to 32 steps of red, green and blue, with a warning. `place` appears in messages: "scan.ply: colours of faces".
void use_face_colors(SourceMesh& mesh, const std::vector<Eigen::Vector3f>& colors, const std::string& place);

/// Clamps the colours of vertices to 0 .. 1, with a warning where some are outside. Throws BadInput for a vertex that
/// faces use whose colour is not a finite number.
void check_vertex_colors(const std::string& file, SourceMesh& mesh);

}  // namespace kiln
