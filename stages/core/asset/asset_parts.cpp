#include "asset/asset_parts.h"

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "image/image_file.h"
#include "mesh/draco_file.h"

namespace kiln {

namespace {

template <class Texel>
void require_size(const Image<Texel>& picture, const std::filesystem::path& file, int width, int height,
                  const std::string& remedy) {
  const std::string size = std::to_string(picture.width()) + " x " + std::to_string(picture.height());
  const std::string expected = std::to_string(width) + " x " + std::to_string(height);
  if (size != expected)
    throw BadInput(file.string(), "is " + size + " texels", expected + ", as the folder's JSON has it", remedy);
}

template <class Texel>
void require_grey(const Image<Texel>& picture, const std::filesystem::path& file, int width, int height,
                  const std::string& remedy) {
  require_size(picture, file, width, height, remedy);
  if (picture.channels() != 1)
    throw BadInput(file.string(), "has " + std::to_string(picture.channels()) + " channels", "a grey PNG", remedy);
}

}  // namespace

template <>
Image<std::uint8_t> read_grey(const std::filesystem::path& file, int width, int height, const std::string& remedy) {
  Image<std::uint8_t> picture = read_png8(file);
  require_grey(picture, file, width, height, remedy);
  return picture;
}

template <>
Image<std::uint16_t> read_grey(const std::filesystem::path& file, int width, int height, const std::string& remedy) {
  Image<std::uint16_t> picture = read_png16(file);
  require_grey(picture, file, width, height, remedy);
  return picture;
}

TriangleMesh read_asset_mesh(const std::filesystem::path& file) {
  TriangleMesh mesh = load_atlas(file);
  require_drawable(mesh, file);
  return mesh;
}

void read_normals(const Fields& fields, PrtAsset& asset) {
  if (!fields.has("normals")) return;
  asset.normals_file = fields.safe_path("normals");
  if (!fields.has("normal_space")) return;
  const std::string space = fields.text("normal_space", "object or tangent");
  if (space != "object" && space != "tangent") fields.fail(fields.path("normal_space"), space, "object or tangent");
  asset.normal_space = space == "tangent" ? NormalSpace::tangent : NormalSpace::object;
}

void require_drawable(const TriangleMesh& mesh, const std::filesystem::path& file) {
  const auto is_there = [&](std::uint32_t vertex) { return vertex < mesh.positions.size(); };
  for (const Triangle& triangle : mesh.triangles)
    if (!std::all_of(triangle.begin(), triangle.end(), is_there))
      throw BadInput(file.string(), "has a triangle with a vertex that is not there", "the mesh of a baked asset",
                     "bake the asset again with kiln-bake");
  const float diagonal = bounding_box(mesh).diagonal();
  if (!(std::isfinite(diagonal) && diagonal > 0))
    throw BadInput(file.string(), "is as large as " + std::to_string(diagonal), "a mesh of finite size above 0",
                   "scale the mesh and start over with kiln-simplify");
}

PrtAlbedo read_albedo(const Fields& fields, const std::filesystem::path& folder, int width, int height,
                      const std::string& remedy) {
  PrtAlbedo albedo;
  albedo.known = fields.has("albedo");
  if (!albedo.known) return albedo;
  const std::string expected = "the name of a picture, or three numbers of 0 to 1";
  const nlohmann::json& value = fields.get("albedo", expected);
  if (value.is_array()) {
    const auto is_share = [](const nlohmann::json& v) { return v.is_number() && v >= 0 && v <= 1; };
    if (value.size() != 3 || !std::all_of(value.begin(), value.end(), is_share))
      fields.fail("albedo", value.dump(), expected);
    for (int c = 0; c < 3; ++c) albedo.constant[c] = value[static_cast<std::size_t>(c)].get<float>();
    return albedo;
  }
  albedo.file = fields.safe_path("albedo");
  const std::filesystem::path file = folder / albedo.file;
  albedo.picture = read_png8(file);
  require_size(albedo.picture, file, width, height, remedy);
  if (albedo.picture.channels() != 3)
    throw BadInput(file.string(), "has " + std::to_string(albedo.picture.channels()) + " channels", "an RGB PNG",
                   remedy);
  return albedo;
}

}  // namespace kiln
