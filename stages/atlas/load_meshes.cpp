// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/load_meshes.h"

#include "base/errors.h"
#include "import/import_mesh.h"
#include "import/uv_mesh.h"
#include "mesh/draco_file.h"

namespace kiln {

TriangleMesh load_low_mesh(const std::filesystem::path& file, const AtlasSettings& settings,
                           std::vector<std::string>& warnings) {
  if (is_draco_file(file)) {
    TriangleMesh mesh = load_draco(file);
    if (settings.uv == UvChoice::keep && mesh.uvs.empty())
      throw BadInput(file.string(), "has no texture coordinates", "a mesh with uvs", "give --uv new to make them");
    if (mesh.normals.empty()) compute_vertex_normals(mesh);
    return mesh;
  }
  if (settings.uv == UvChoice::keep) return load_uv_mesh(file, settings.import, &warnings);
  const ImportedMesh imported = import_mesh(file, settings.import);
  warnings.insert(warnings.end(), imported.warnings.begin(), imported.warnings.end());
  if (const std::string fault = fault_of_uvs(imported.surface); !fault.empty())
    warnings.push_back(file.string() + ": " + fault);
  return split_at_seams(imported);
}

TriangleMesh load_high_mesh(const std::filesystem::path& file, const ImportSettings& settings, const MeshFrame& frame,
                            std::vector<std::string>& warnings) {
  ImportedMesh imported = import_mesh(file, settings, frame);
  warnings.insert(warnings.end(), imported.warnings.begin(), imported.warnings.end());
  return std::move(imported.mesh);
}

}  // namespace kiln
