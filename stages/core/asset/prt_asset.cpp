#include "asset/prt_asset.h"

#include "asset/asset_parts.h"
#include "asset/fields.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

using nlohmann::json;

constexpr const char* remedy = "bake the asset again with kiln-bake";

PrtPlane read_plane(const Fields& fields, const PrtAsset& asset, int index, bool in_a_file) {
  const int coefficients = asset.bands * asset.bands;
  PrtPlane plane;
  if (in_a_file) plane.file = fields.safe_path("file");
  plane.channel = fields.integer("channel", 0, asset.channels - 1);
  plane.coefficient = fields.integer("coefficient", 0, coefficients - 1);
  if (plane.channel != index / coefficients || plane.coefficient != index % coefficients)
    fields.fail(fields.path("coefficient"),
                std::to_string(plane.coefficient) + " of channel " + std::to_string(plane.channel),
                "coefficient " + std::to_string(index % coefficients) + " of channel " +
                    std::to_string(index / coefficients) + " (each plane once, in order)");
  plane.lowest = fields.number("min");
  plane.highest = fields.number("max");
  if (plane.lowest > plane.highest)
    fields.fail(fields.path("min"), std::to_string(plane.lowest) + ", above max " + std::to_string(plane.highest),
                "min <= max");
  return plane;
}

/// Fills in everything that stands in ranges.json itself.
void read_ranges(const Fields& fields, PrtAsset& asset) {
  fields.constant("format", "kiln-prt");
  fields.integer("version", 1, 1);
  fields.constant("basis", "real-sh-orthonormal");
  asset.bands = fields.integer("bands", 1, most_asset_bands);
  asset.channels = fields.integer("channels", 1, most_asset_channels);
  asset.bits = fields.integer("bits", 8, 16);
  if (asset.bits != 8 && asset.bits != 16) fields.fail("bits", std::to_string(asset.bits), "8 or 16");
  const bool textured = !fields.has("vertices");
  if (textured) {
    asset.width = fields.integer("width", 1, largest_asset_side);
    asset.height = fields.integer("height", 1, largest_asset_side);
  }
  asset.mesh_file = fields.safe_path("mesh");
  read_normals(fields, asset);
  asset.albedo = read_albedo(fields, asset.ranges_file.parent_path(), asset.width, asset.height, remedy);

  const std::size_t count = static_cast<std::size_t>(asset.channels) * asset.bands * asset.bands;
  const std::string expected = "a list of " + std::to_string(count) + " planes";
  const json& planes = fields.get("planes", expected);
  if (!planes.is_array()) fields.fail("planes", "no list", expected);
  if (planes.size() != count) fields.fail("planes", "a list of " + std::to_string(planes.size()), expected);
  for (std::size_t k = 0; k < count; ++k) {
    const Fields plane(fields.file(), "planes[" + std::to_string(k) + "]", planes[k], remedy);
    asset.planes.push_back(read_plane(plane, asset, static_cast<int>(k), textured));
  }
}

}  // namespace

PrtAsset load_prt_asset(const fs::path& folder) {
  std::error_code error;
  const fs::path ranges = folder / ranges_name, compressed = folder / pca_name;
  if (fs::is_regular_file(compressed, error)) return load_pca_asset(folder);
  if (!fs::is_directory(folder, error) || !fs::is_regular_file(ranges, error))
    throw BadInput(folder.string(), fs::is_directory(folder, error) ? "has no ranges.json" : "is no folder",
                   "the output folder of kiln-bake or kiln-compress", "run kiln-bake, or name its output folder");
  PrtAsset asset;
  asset.ranges_file = ranges;
  const json document = parse_json(ranges, "kiln-bake", remedy);
  const Fields fields(ranges.string(), "", document, remedy);
  read_ranges(fields, asset);
  if (fields.has("vertices")) {
    read_vertex_transfer(folder, fields, asset);
    return asset;
  }
  asset.mesh = read_asset_mesh(folder / asset.mesh_file);
  std::vector<std::string> files;
  for (const PrtPlane& plane : asset.planes) files.push_back(plane.file);
  if (asset.bits == 8)
    asset.pictures = read_grey_pictures<std::uint8_t>(folder, files, asset.width, asset.height, remedy);
  else
    asset.pictures = read_grey_pictures<std::uint16_t>(folder, files, asset.width, asset.height, remedy);
  return asset;
}

PrtAsset load_other_form(const fs::path& folder, const PrtAsset& asset) {
  PrtAsset other = load_prt_asset(folder);
  if (other.bands != asset.bands)
    throw BadInput(folder.string(), "has " + std::to_string(other.bands) + " bands",
                   std::to_string(asset.bands) + ", as the asset has",
                   "name the output of kiln-compress for this asset");
  return other;
}

}  // namespace kiln
