// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/scene/receiver_set.h"

#include <algorithm>
#include <limits>

#include "base/parallel.h"
#include "mesh/uv_raster.h"
#include "raycast/ray_scene.h"

namespace kiln {

namespace {

constexpr int outer_tile_texels = 16;  // the 256 texels of a full tile are one stream of rays
constexpr int inner_tile_texels = 8;   // its 64 texels are one workgroup of the GPU

/// Calls visit(i, j) for all texels, tile after tile, and within each in four smaller tiles.
template <class Visit>
void for_each_texel(int width, int height, const Visit& visit) {
  const auto for_each_tile = [](int first_i, int first_j, int last_i, int last_j, int side, const auto& inner) {
    for (int j = first_j; j < last_j; j += side)
      for (int i = first_i; i < last_i; i += side) inner(i, j, std::min(i + side, last_i), std::min(j + side, last_j));
  };
  for_each_tile(0, 0, width, height, outer_tile_texels, [&](int outer_i, int outer_j, int end_i, int end_j) {
    for_each_tile(outer_i, outer_j, end_i, end_j, inner_tile_texels, [&](int i, int j, int last_i, int last_j) {
      for_each_tile(i, j, last_i, last_j, 1, [&](int at_i, int at_j, int, int) { visit(at_i, at_j); });
    });
  });
}

Eigen::Vector3f vector_at(const Image<float>& image, int i, int j) {
  return {image.at(i, j, 0), image.at(i, j, 1), image.at(i, j, 2)};
}

}  // namespace

void FillPlan::apply(std::span<float> plane) const {
  for (const Texel& fill : texels) {
    float sum = 0;
    for (std::uint32_t k = 0; k < fill.sources; ++k) sum += plane[sources[fill.first_source + k]];
    plane[fill.texel] = sum / static_cast<float>(fill.sources);
  }
}

std::vector<std::uint8_t> ReceiverSet::covered() const {
  std::vector<std::uint8_t> flags(static_cast<std::size_t>(width) * height, 0);
  for (const std::uint32_t slot : slots) flags[slot] = 1;
  return flags;
}

ReceiverSet receivers_on_high(const DetailMaps& detail) {
  ReceiverSet receivers{detail.width, detail.height, {}, {}, {}};
  for_each_texel(detail.width, detail.height, [&](int i, int j) {
    const std::uint32_t texel = static_cast<std::uint32_t>(j) * detail.width + i;
    if (detail.covered[texel] == 0) return;
    receivers.slots.push_back(texel);
    receivers.positions.push_back(vector_at(detail.position, i, j));
    receivers.normals.push_back(vector_at(detail.normal_object, i, j));
  });
  return receivers;
}

ReceiverSet receivers_on_low(const TriangleMesh& atlas, int width, int height, const DetailMaps* detail) {
  const UvRaster raster = rasterise_uvs(atlas, width, height);
  ReceiverSet receivers{width, height, {}, {}, {}};
  for_each_texel(width, height, [&](int i, int j) {
    const TexelSource& source = raster.at(i, j);
    if (!source.covered()) return;
    receivers.slots.push_back(static_cast<std::uint32_t>(j) * width + i);
    receivers.positions.push_back(interpolate(atlas, atlas.positions, source));
    receivers.normals.push_back(detail != nullptr
                                    ? vector_at(detail->normal_object, i, j)
                                    : Eigen::Vector3f(interpolate(atlas, atlas.normals, source).normalized()));
  });
  return receivers;
}

void take_albedos(ReceiverSet& receivers, const DetailMaps& detail) {
  receivers.albedos.clear();
  for (std::uint32_t texel : receivers.slots)
    receivers.albedos.push_back(
        detail.albedo_at(static_cast<int>(texel % detail.width), static_cast<int>(texel / detail.width)));
}

void take_albedos(ReceiverSet& receivers, const Occluders& occluders) {
  const RayScene surface(occluders.mesh);
  receivers.albedos.resize(receivers.positions.size());
  parallel_for(std::size_t{0}, receivers.positions.size(), [&](std::size_t r) {
    const SurfacePoint at = surface.closest_point(receivers.positions[r], std::numeric_limits<float>::infinity());
    receivers.albedos[r] = occluders.albedo_at(at.triangle, at.u, at.v);
  });
}

}  // namespace kiln
