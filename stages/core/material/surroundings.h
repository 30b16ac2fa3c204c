// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "import/import_settings.h"
#include "material/load_albedo.h"
#include "material/material_settings.h"
#include "material/surroundings_settings.h"
#include "mesh/placement.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Another mesh of the scene that an asset stands in.
struct Neighbour {
  std::filesystem::path file;
  Placement placement;  ///< placement in the scene
  MaterialSettings material;
  ImportSettings import;
};

/// Reads
/// "FILE[;place=X,Y,Z[,AZIMUTH[,SCALE]]][;albedo=A][;albedo-texture=PICTURE][;reflectance=R][;reflectance-of=M=R][;albedo-encoding=E]"
/// and the import options, such as ";up=+z" and ";fill-holes=EDGES", each value in the form that the option of that
/// name takes. A semicolon or backslash in a name is escaped by a backslash. Throws WrongUsage.
Neighbour parse_neighbour(const std::string& text);

/// Mesh around an asset, in the asset's object space.
struct PlacedMesh {
  std::string name;   ///< its file, or "the ground"
  TriangleMesh mesh;  ///< with corner normals, which are turned like the mesh
  std::vector<std::string> warnings;
  LoadedAlbedo material;
  std::vector<std::filesystem::path> opacity_files;  ///< pictures of opacity that were read
  std::vector<std::uint8_t> sheets;                  ///< 1 for each triangle that opacity may cut; empty: none
};

/// Loads the meshes around an asset whose box in its own frame is `own`: the neighbours, in their order, then the
/// ground, centred below the middle of the box. The ground reflects the constant that `material` gives. Loads albedo
/// only if `with_albedo`. Throws WrongUsage, and BadInput for files that are missing or damaged.
std::vector<PlacedMesh> load_surroundings(const Surroundings& surroundings, const BoundingBox& own,
                                          const MaterialSettings& material, bool with_albedo,
                                          const MeshFrame& frame = {});

}  // namespace kiln
