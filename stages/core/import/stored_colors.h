#pragma once

#include <string>
#include <vector>

#include "import/source_mesh.h"

namespace kiln {

/// Gives the faces of a mesh materials by their colours, one for each colour that is there, in the order in which they
/// come up. `colors` are as many as faces, 0 to 1; not finite ones are of faces without a colour. More than 65,536 are
/// rounded to 32 steps of red, green and blue, with a warning. `place` is for messages: "scan.ply: colours of faces".
void use_face_colors(SourceMesh& mesh, const std::vector<Eigen::Vector3f>& colors, const std::string& place);

/// Brings the colours of vertices to 0 to 1, with a warning where some are outside. Throws BadInput for a vertex that
/// faces use whose colour is not a finite number.
void check_vertex_colors(const std::string& file, SourceMesh& mesh);

}  // namespace kiln
