// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "export/glb_file.h"
#include "mesh/draco_file.h"

namespace kiln {

/// How the mesh stands in the file.
enum class GlbMeshForm {
  draco,    ///< KHR_draco_mesh_compression: quantised as Kiln's own Draco files are
  meshopt,  ///< EXT_meshopt_compression: lossless
  plain,    ///< floats
};

/// Mesh as glTF has it: positions relative to the origin in the file's units, v downwards, tangents with a sign.
struct GlbMesh {
  AttributedMesh mesh;                    ///< its frame is the identity
  std::vector<Eigen::Vector4f> tangents;  ///< one per vertex, or empty
};

/// Turns a mesh of Kiln, with its tangents if asked for, into glTF's.
GlbMesh glb_mesh_of(const AttributedMesh& source, bool with_tangents);

/// Returns the name in glTF of a vertex attribute of the format: "kiln-prt-0-1" is "_KILN_PRT_0_1".
std::string glb_attribute_name(const std::string& attribute);

/// What was added to a file.
struct AddedMesh {
  Json primitive;  ///< without its material
  std::size_t vertices = 0, triangles = 0;
};

/// Adds a mesh with its accessors, which say what readers get: with Draco, the mesh as decoders yield it.
AddedMesh add_mesh(GlbFile& file, const GlbMesh& mesh, GlbMeshForm form);

}  // namespace kiln
