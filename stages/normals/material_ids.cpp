// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/material_ids.h"

#include <algorithm>
#include <map>

#include "mesh/mesh_components.h"

namespace kiln {

namespace {

/// Returns a name that none of `names` is: `name`, or where that is empty or taken one with a number.
std::string unique_name(const std::string& name, const std::vector<std::string>& names) {
  std::string unique = name.empty() ? "material" : name;
  for (int number = 2; std::find(names.begin(), names.end(), unique) != names.end(); ++number)
    unique = (name.empty() ? "material" : name) + " " + std::to_string(number);
  return unique;
}

}  // namespace

MaterialIds find_material_ids(const ImportedMesh& mesh) {
  MaterialIds ids;
  const std::vector<std::int32_t>& materials = mesh.surface.material_of;
  if (materials.empty()) {
    const Components parts = find_components(mesh.mesh);
    ids.of_triangle = parts.of_triangle;
    for (std::size_t part = 1; part <= parts.count; ++part) ids.names.push_back("part " + std::to_string(part));
    return ids;
  }
  std::map<std::int32_t, std::uint32_t> known;
  for (const std::int32_t material : materials) {
    const auto [entry, is_new] = known.emplace(material, static_cast<std::uint32_t>(ids.names.size()));
    ids.of_triangle.push_back(entry->second);
    if (!is_new) continue;
    const std::string name = material < 0 ? "none" : mesh.surface.materials.at(static_cast<std::size_t>(material)).name;
    ids.names.push_back(unique_name(name, ids.names));
  }
  return ids;
}

}  // namespace kiln
