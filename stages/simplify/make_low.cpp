// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/make_low.h"

#include "simplify/kept_surface.h"
#include "simplify/simplify.h"

namespace kiln {

KeepingResult make_low(const ImportedMesh& high, const OwnLow* own_low, const SimplifySettings& settings, LowFile& file,
                       std::vector<std::string>& warnings, const ProgressFunction& progress) {
  const WrittenForm written = [&](const TriangleMesh& mesh) { return file.write(mesh); };
  const WrittenForm as_it_is = [&](const TriangleMesh& mesh) { return file.write_as_it_is(mesh); };
  const WrittenWithMaterials with_materials = [&](const TriangleMesh& mesh, const VertexMaterials& materials) {
    return file.write_as_it_is(mesh, materials.attributes());
  };
  if (own_low != nullptr) return {take_low(high.mesh, own_low->mesh, as_it_is, progress), {}};
  if (settings.keeps_uvs()) {
    const KeptSurface surface = kept_surface(high, settings);
    warnings.insert(warnings.end(), surface.warnings.begin(), surface.warnings.end());
    return simplify_with_uvs(high, surface, settings, with_materials, progress);
  }
  if (settings.keeps_materials()) return simplify_with_materials(high, settings, written, with_materials, progress);
  return {simplify(high.mesh, settings, written, progress), {}};
}

}  // namespace kiln
