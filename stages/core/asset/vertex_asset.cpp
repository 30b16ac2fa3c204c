#include <algorithm>
#include <cmath>

#include "asset/asset_parts.h"
#include "mesh/draco_file.h"

namespace kiln {

namespace fs = std::filesystem;

void read_vertex_transfer(const fs::path& folder, const Fields& fields, PrtAsset& asset) {
  const std::string remedy = "bake the asset again with kiln-bake --per-vertex";
  const fs::path file = folder / asset.mesh_file;
  AttributedMesh stored = load_attributed_draco(file);
  const std::size_t vertices = stored.mesh.positions.size();
  const int most = 1 << 30, listed = fields.integer("vertices", 1, most);
  if (static_cast<std::size_t>(listed) != vertices)
    throw BadInput(file.string(), "has " + std::to_string(vertices) + " vertices",
                   std::to_string(listed) + ", as ranges.json has it", remedy);
  asset.mesh = std::move(stored.mesh);
  require_drawable(asset.mesh, file);
  if (asset.mesh.normals.size() != vertices) compute_vertex_normals(asset.mesh);

  const std::size_t length = asset.vector_length();
  const double white = std::exp2(asset.bits) - 1;
  const nlohmann::json& planes = fields.get("planes", "a list");  // of `length` objects: read_ranges has checked that
  asset.vertex_transfer.resize(vertices * length);
  for (std::size_t k = 0; k < length; ++k) {
    const Fields plane(fields.file(), "planes[" + std::to_string(k) + "]", planes[k], remedy);
    const std::string name = plane.text("attribute", "the name of an attribute of the mesh");
    const auto attribute = std::find_if(stored.attributes.begin(), stored.attributes.end(),
                                        [&](const IntegerAttribute& candidate) { return candidate.name == name; });
    if (attribute == stored.attributes.end())
      throw BadInput(file.string(), "has no attribute '" + name + "'", "the one that ranges.json names", remedy);
    if (attribute->bits != asset.bits)
      throw BadInput(file.string(), "has " + std::to_string(attribute->bits) + " bits in attribute '" + name + "'",
                     std::to_string(asset.bits) + ", as ranges.json has it", remedy);
    const auto components = static_cast<std::size_t>(attribute->components);
    const auto component = static_cast<std::size_t>(plane.integer("component", 0, attribute->components - 1));
    const double lowest = asset.planes[k].lowest, step = (asset.planes[k].highest - lowest) / white;
    for (std::size_t v = 0; v < vertices; ++v)
      asset.vertex_transfer[v * length + k] =
          static_cast<float>(lowest + step * attribute->values[v * components + component]);
  }
}

}  // namespace kiln
