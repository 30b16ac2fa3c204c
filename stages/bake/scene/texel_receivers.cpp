#include "bake/scene/texel_receivers.h"

#include <algorithm>

#include "mesh/uv_raster.h"

namespace kiln {

namespace {

constexpr int tile_texels = 16;  // 256 texels of a full tile are one stream of rays

/// Calls visit(i, j) for all texels, tile after tile.
template <class Visit>
void for_each_texel(int width, int height, const Visit& visit) {
  for (int tile_j = 0; tile_j < height; tile_j += tile_texels)
    for (int tile_i = 0; tile_i < width; tile_i += tile_texels)
      for (int j = tile_j; j < std::min(tile_j + tile_texels, height); ++j)
        for (int i = tile_i; i < std::min(tile_i + tile_texels, width); ++i) visit(i, j);
}

Eigen::Vector3f vector_at(const Image<float>& image, int i, int j) {
  return {image.at(i, j, 0), image.at(i, j, 1), image.at(i, j, 2)};
}

}  // namespace

std::vector<std::uint8_t> TexelReceivers::covered() const {
  std::vector<std::uint8_t> flags(static_cast<std::size_t>(width) * height, 0);
  for (std::uint32_t texel : texels) flags[texel] = 1;
  return flags;
}

TexelReceivers receivers_on_high(const DetailMaps& detail) {
  TexelReceivers receivers{detail.width, detail.height, {}, {}, {}};
  for_each_texel(detail.width, detail.height, [&](int i, int j) {
    const std::uint32_t texel = static_cast<std::uint32_t>(j) * detail.width + i;
    if (detail.covered[texel] == 0) return;
    receivers.texels.push_back(texel);
    receivers.positions.push_back(vector_at(detail.position, i, j));
    receivers.normals.push_back(vector_at(detail.normal_object, i, j));
  });
  return receivers;
}

TexelReceivers receivers_on_low(const TriangleMesh& atlas, int width, int height, const DetailMaps* detail) {
  const UvRaster raster = rasterise_uvs(atlas, width, height);
  TexelReceivers receivers{width, height, {}, {}, {}};
  for_each_texel(width, height, [&](int i, int j) {
    const TexelSource& source = raster.at(i, j);
    if (!source.covered()) return;
    receivers.texels.push_back(static_cast<std::uint32_t>(j) * width + i);
    receivers.positions.push_back(interpolate(atlas, atlas.positions, source));
    receivers.normals.push_back(detail != nullptr
                                    ? vector_at(detail->normal_object, i, j)
                                    : Eigen::Vector3f(interpolate(atlas, atlas.normals, source).normalized()));
  });
  return receivers;
}

}  // namespace kiln
