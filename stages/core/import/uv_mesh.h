// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "import/import_mesh.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Reads a mesh with its texture coordinates, from any format that read_source_mesh knows and that can hold them.
/// Corners of the same position, uv and normal become one vertex; polygons are triangulated (triangulate); normals are
/// the file's, or computed from the faces, the same on both sides of a seam. Nothing is repaired or dropped: triangles
/// are those of the file, in its order, in the frame of import_mesh. `warnings`, if given, receive what the file has
/// and Kiln does not use. Throws BadInput for faces without texture coordinates and for what cannot be read. Uvs may
/// lie outside the unit square.
TriangleMesh load_uv_mesh(const std::filesystem::path& file, const ImportSettings& settings = {},
                          std::vector<std::string>* warnings = nullptr);

/// Tells whether every corner of an imported mesh has a uv of the file.
bool has_whole_uvs(const ImportedSurface& surface);

/// Says that uvs are dropped since a face, which it names, has none; empty where all faces have uvs, or none has.
std::string fault_of_uvs(const ImportedSurface& surface);

/// Returns an imported mesh with one normal and one uv per vertex: vertices are split at hard edges and at the seams of
/// the file's uvs; triangles keep their order. Without uvs where has_whole_uvs is false.
TriangleMesh split_at_seams(const ImportedMesh& imported);

}  // namespace kiln
