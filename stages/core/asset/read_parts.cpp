// SPDX-License-Identifier: MIT
#include "asset/read_parts.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <fmt/format.h>

#include "asset/read_description.h"
#include "base/errors.h"
#include "base/parallel.h"
#include "image/image_file.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

/// Throws unless the mesh can be drawn: its triangles refer to its vertices, and its extent is above 0.
void require_drawable(const TriangleMesh& mesh, const fs::path& file) {
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

}  // namespace

template <class Texel>
void require_picture(const Image<Texel>& picture, const fs::path& file, int width, int height, int channels,
                     const std::string& remedy) {
  if (picture.width() != width || picture.height() != height)
    throw BadInput(file.string(), fmt::format("is {} x {} texels", picture.width(), picture.height()),
                   fmt::format("{} x {}, as the folder's JSON has it", width, height), remedy);
  if (picture.channels() != channels)
    throw BadInput(file.string(), fmt::format("has {} channels", picture.channels()),
                   channels == 1 ? "a grey PNG" : "an RGB PNG", remedy);
}

template void require_picture(const Image<std::uint8_t>&, const fs::path&, int, int, int, const std::string&);
template void require_picture(const Image<std::uint16_t>&, const fs::path&, int, int, int, const std::string&);

template <>
Image<std::uint8_t> read_grey(const fs::path& file, int width, int height, const std::string& remedy) {
  Image<std::uint8_t> picture = read_png8(file);
  require_picture(picture, file, width, height, 1, remedy);
  return picture;
}

template <>
Image<std::uint16_t> read_grey(const fs::path& file, int width, int height, const std::string& remedy) {
  Image<std::uint16_t> picture = read_png16(file);
  require_picture(picture, file, width, height, 1, remedy);
  return picture;
}

template <class Texel>
std::vector<Image<Texel>> read_grey_pictures(const fs::path& folder, const PrtDescription& asset,
                                             const std::string& remedy) {
  std::vector<Image<Texel>> pictures(asset.planes.size());
  std::vector<std::exception_ptr> faults(asset.planes.size());
  parallel_for(std::size_t{0}, pictures.size(), [&](std::size_t k) {
    try {
      pictures[k] = read_grey<Texel>(folder / asset.planes[k].file, asset.width, asset.height, remedy);
    } catch (...) {
      faults[k] = std::current_exception();
    }
  });
  for (const std::exception_ptr& fault : faults)
    if (fault) std::rethrow_exception(fault);
  return pictures;
}

template std::vector<Image<std::uint8_t>> read_grey_pictures(const fs::path&, const PrtDescription&,
                                                             const std::string&);
template std::vector<Image<std::uint16_t>> read_grey_pictures(const fs::path&, const PrtDescription&,
                                                              const std::string&);

TriangleMesh read_atlas_mesh(const fs::path& folder, const PrtDescription& asset) {
  const fs::path file = folder / asset.mesh_file;
  TriangleMesh mesh = load_atlas(file);
  require_drawable(mesh, file);
  return mesh;
}

TriangleMesh read_level_mesh(const fs::path& folder, const PrtDescription& asset, const PrtLevel& level) {
  const fs::path file = folder / level.mesh_file;
  TriangleMesh mesh = load_atlas(file);
  require_drawable(mesh, file);
  if (mesh.triangles.size() != static_cast<std::size_t>(level.triangles))
    throw BadInput(file.string(), fmt::format("has {} triangles", mesh.triangles.size()),
                   fmt::format("{}, as the folder's JSON has it", level.triangles), remedy_for(asset));
  return mesh;
}

AttributedMesh read_vertex_mesh(const fs::path& folder, const PrtDescription& asset) {
  const fs::path file = folder / asset.mesh_file;
  const std::string remedy = remedy_for(asset);
  AttributedMesh stored = load_attributed_draco(file);
  const std::size_t vertices = stored.mesh.positions.size();
  if (static_cast<std::size_t>(asset.vertices) != vertices)
    throw BadInput(file.string(), "has " + std::to_string(vertices) + " vertices",
                   std::to_string(asset.vertices) + ", as ranges.json has it", remedy);
  require_drawable(stored.mesh, file);
  if (stored.mesh.normals.size() != vertices) compute_vertex_normals(stored.mesh);
  return stored;
}

const IntegerAttribute& attribute_of(const AttributedMesh& mesh, const fs::path& folder, const PrtDescription& asset,
                                     std::size_t k) {
  const PrtPlane& plane = asset.planes[k];
  const std::string file = (folder / asset.mesh_file).string(), remedy = remedy_for(asset);
  const auto found = std::find_if(mesh.attributes.begin(), mesh.attributes.end(),
                                  [&](const IntegerAttribute& candidate) { return candidate.name == plane.attribute; });
  if (found == mesh.attributes.end())
    throw BadInput(file, "has no attribute '" + plane.attribute + "'", "the one that ranges.json names", remedy);
  if (found->bits != plane.bits)
    throw BadInput(file, fmt::format("has {} bits in attribute '{}'", found->bits, plane.attribute),
                   std::to_string(plane.bits) + ", as ranges.json has it", remedy);
  if (plane.component >= found->components)
    throw BadInput(asset.ranges_file.string(), fmt::format("planes[{}].component is {}", k, plane.component),
                   fmt::format("a whole number of 0 to {}", found->components - 1), remedy);
  return *found;
}

std::vector<float> vertex_values(const IntegerAttribute& attribute, const PrtPlane& plane,
                                 std::span<const std::uint32_t> vertices) {
  const auto components = static_cast<std::size_t>(attribute.components),
             component = static_cast<std::size_t>(plane.component);
  std::vector<float> values(vertices.size());
  std::transform(vertices.begin(), vertices.end(), values.begin(), [&](std::uint32_t vertex) {
    return static_cast<float>(plane.range.recover(attribute.values.at(vertex * components + component), plane.bits));
  });
  return values;
}

Image<std::uint8_t> read_albedo_picture(const fs::path& folder, const PrtDescription& asset) {
  if (asset.albedo.file.empty()) return {};
  const fs::path file = folder / asset.albedo.file;
  Image<std::uint8_t> picture = read_png8(file);
  const PrtAlbedo& albedo = asset.albedo;
  require_picture(picture, file, albedo.has_own_size() ? albedo.width : asset.width,
                  albedo.has_own_size() ? albedo.height : asset.height, 3, remedy_for(asset));
  return picture;
}

Image<std::uint8_t> read_measured_picture(const fs::path& folder, const PrtDescription& asset) {
  const PrtAlbedo& albedo = asset.albedo;
  if (albedo.measured_file.empty()) return {};
  const fs::path file = folder / albedo.measured_file;
  Image<std::uint8_t> picture = read_png8(file);
  require_picture(picture, file, asset.width, asset.height, 1, remedy_for(asset));
  const std::size_t largest = *std::ranges::max_element(picture.values());
  if (largest > albedo.reflectances.size())
    throw BadInput(file.string(), fmt::format("has the number {}", largest),
                   fmt::format("0 to {}, as many as there are reflectances", albedo.reflectances.size()),
                   remedy_for(asset));
  return picture;
}

Image<std::uint8_t> read_opacity_picture(const fs::path& folder, const PrtDescription& asset) {
  if (asset.opacity_file.empty()) return {};
  const fs::path file = folder / asset.opacity_file;
  Image<std::uint8_t> picture = read_png8(file);
  require_picture(picture, file, picture.width(), picture.height(), 1, remedy_for(asset));
  if (std::max(picture.width(), picture.height()) > largest_asset_side)
    throw BadInput(file.string(), "has more texels a side than " + std::to_string(largest_asset_side),
                   "a picture that GPUs can hold", remedy_for(asset));
  return picture;
}

std::vector<float> read_vectors(const fs::path& folder, const PrtDescription& asset) {
  const PcaTables& tables = *asset.pca;
  // Rows of the picture are counted from the top.
  const int rows_of_each = static_cast<int>(asset.planes.size()) + 1, rows = tables.clusters * rows_of_each;
  const int length = static_cast<int>(asset.vector_length());
  const Image<std::uint16_t> stored =
      read_grey<std::uint16_t>(folder / tables.vectors_file, length, rows, remedy_for(asset));
  std::vector<float> vectors;
  for (int row = 0; row < rows; ++row) {
    const PlaneRange& range = tables.vector_ranges[static_cast<std::size_t>(row % rows_of_each)];
    for (int i = 0; i < length; ++i) {
      const double scale = tables.coefficient_scales[static_cast<std::size_t>(i) % tables.coefficient_scales.size()];
      vectors.push_back(static_cast<float>(range.recover(stored.at(i, rows - 1 - row), 16) * scale));
    }
  }
  return vectors;
}

Image<std::uint8_t> read_cluster_ids(const fs::path& folder, const PrtDescription& asset) {
  if (asset.pca->ids_file.empty()) return {};
  const fs::path file = folder / asset.pca->ids_file;
  Image<std::uint8_t> ids = read_grey<std::uint8_t>(file, asset.width, asset.height, remedy_for(asset));
  const int highest = *std::max_element(ids.values().begin(), ids.values().end());
  if (highest >= asset.pca->clusters)
    throw BadInput(file.string(), "has a texel of cluster " + std::to_string(highest),
                   "clusters 0 to " + std::to_string(asset.pca->clusters - 1), remedy_for(asset));
  return ids;
}

}  // namespace kiln
