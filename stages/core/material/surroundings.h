#pragma once

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
  Placement placement;  ///< in the scene
  MaterialSettings material;
  ImportSettings import;
};

/// Reads "FILE[;place=X,Y,Z[,AZIMUTH[,SCALE]]][;albedo=A][;albedo-texture=PICTURE][;albedo-encoding=E]"
/// and the import options, such as ";up=+z" and ";fill-holes=EDGES", each value as the option of that name takes it.
/// A semicolon or backslash of a name is written with a backslash before it. Throws WrongUsage.
Neighbour parse_neighbour(const std::string& text);

/// A mesh around an asset, in the asset's object space.
struct PlacedMesh {
  std::string name;   ///< its file, or "the ground"
  TriangleMesh mesh;  ///< with corner normals, turned like itself
  std::vector<std::string> warnings;
  LoadedAlbedo material;
};

/// Loads what stands around an asset whose box in its own frame is `own`: the neighbours, in their order, then the
/// ground, which lies below the middle of the box. The ground reflects what `material` gives as a constant. Albedo is
/// loaded `with_albedo` alone. Throws WrongUsage, and BadInput for files that are missing or damaged.
std::vector<PlacedMesh> load_surroundings(const Surroundings& surroundings, const BoundingBox& own,
                                          const MaterialSettings& material, bool with_albedo,
                                          const MeshFrame& frame = {});

}  // namespace kiln
