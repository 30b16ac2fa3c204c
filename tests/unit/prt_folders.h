// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "gpu/egl_context.h"
#include "image/gutter.h"
#include "image/image_file.h"
#include "mesh/draco_file.h"
#include "mesh/uv_raster.h"
#include "render/render_settings.h"
#include "runtime/draw/scene_renderer.h"
#include "sh/basis.h"

/// Baked folders for tests, written from the specification, and pictures of them.
namespace kiln::test {

/// A coefficient stack to be written; planes as in ranges.json, values in the planes' own units.
struct Stack {
  int width = 0, height = 0, bands = 1, channels = 1, bits = 8;
  std::vector<Image<float>> planes;
};

template <class Texel>
void write_plane(const std::filesystem::path& file, const Image<float>& plane, double lowest, double highest) {
  const double white = std::numeric_limits<Texel>::max();
  Image<Texel> stored(plane.width(), plane.height(), 1);
  for (std::size_t k = 0; k < plane.values().size(); ++k)
    stored.values()[k] =
        highest > lowest ? static_cast<Texel>(std::lround((plane.values()[k] - lowest) / (highest - lowest) * white))
                         : Texel{0};
  write_png(file, stored);
}

/// Writes a folder as kiln-bake would, from the specification.
inline void write_asset(const std::filesystem::path& folder, const TriangleMesh& mesh, const Stack& stack) {
  nlohmann::json planes = nlohmann::json::array();
  for (std::size_t k = 0; k < stack.planes.size(); ++k) {
    const int channel = static_cast<int>(k) / (stack.bands * stack.bands);
    const int coefficient = static_cast<int>(k) % (stack.bands * stack.bands);
    const std::string name =
        "coeff_" + std::to_string(channel) + (coefficient < 10 ? "_0" : "_") + std::to_string(coefficient) + ".png";
    const auto [low, high] = std::minmax_element(stack.planes[k].values().begin(), stack.planes[k].values().end());
    if (stack.bits == 8)
      write_plane<std::uint8_t>(folder / name, stack.planes[k], *low, *high);
    else
      write_plane<std::uint16_t>(folder / name, stack.planes[k], *low, *high);
    planes.push_back(
        {{"file", name}, {"channel", channel}, {"coefficient", coefficient}, {"min", *low}, {"max", *high}});
  }
  const nlohmann::json ranges = {{"format", "kiln-prt"},   {"version", 1},
                                 {"bands", stack.bands},   {"channels", stack.channels},
                                 {"bits", stack.bits},     {"width", stack.width},
                                 {"height", stack.height}, {"basis", "real-sh-orthonormal"},
                                 {"mesh", "atlas.drc"},    {"normals", "normal.png"},
                                 {"planes", planes}};
  std::ofstream(folder / "ranges.json") << ranges.dump();
  save_draco(folder / "atlas.drc", mesh);
}

/// Makes unoccluded transfer over the atlas of a convex mesh, the same in all channels; `tints` scales the channels.
inline Stack unoccluded_stack(const TriangleMesh& mesh, int width, int height, int bands, int bits,
                              std::vector<float> tints = {1}) {
  Stack stack{width, height, bands, static_cast<int>(tints.size()), bits, {}};
  const ShBasis basis(bands);
  const UvRaster raster = rasterise_uvs(mesh, width, height);
  std::vector<std::uint8_t> covered;
  for (const TexelSource& source : raster.texels) covered.push_back(source.covered());
  stack.planes.assign(static_cast<std::size_t>(basis.size()), Image<float>(width, height, 1));
  for (std::size_t k = 0; k < raster.texels.size(); ++k) {
    if (covered[k] == 0) continue;
    const std::vector<float> transfer =
        unoccluded_transfer(basis, interpolate(mesh, mesh.normals, raster.texels[k]).normalized());
    for (int i = 0; i < basis.size(); ++i) stack.planes[i].values()[k] = transfer[i];
  }
  for (Image<float>& plane : stack.planes) fill_gutters(plane, covered);
  const std::vector<Image<float>> one = stack.planes;
  stack.planes.clear();
  for (const float tint : tints)
    for (Image<float> plane : one) {
      for (float& value : plane.values()) value *= tint;
      stack.planes.push_back(std::move(plane));
    }
  return stack;
}

/// Makes noise in every plane, each with a range of its own; one plane is constant (min = max).
inline Stack noise_stack(int width, int height, int bands, int channels, int bits) {
  Stack stack{width, height, bands, channels, bits, {}};
  std::mt19937 random(7);
  for (int k = 0; k < channels * bands * bands; ++k) {
    std::uniform_real_distribution<float> value(-0.1f * static_cast<float>(k % 3),
                                                0.05f + 0.02f * static_cast<float>(k % 5));
    Image<float>& plane = stack.planes.emplace_back(width, height, 1, 0.125f);
    if (k == 2) continue;
    for (float& texel : plane.values()) texel = value(random);
  }
  return stack;
}

inline std::unique_ptr<EglContext> software_context() { return std::make_unique<EglContext>("software"); }

inline SceneView small_view(const TriangleMesh& mesh, double azimuth, double elevation, int supersample = 1) {
  RenderSettings settings;
  settings.width = 160;
  settings.height = 120;
  settings.supersample = supersample;
  settings.camera = std::to_string(azimuth) + "," + std::to_string(elevation);
  return views_of(settings, mesh.positions).front();
}

/// Draws one asset under a distant light, without a window.
inline Image<float> drawn(const PrtAsset& asset, const LightCoefficients& light, const SceneView& view) {
  AssetRenderer renderer(asset);
  return render_scene({{&renderer, {}, natural_technique(asset)}}, {{}, light, LightWindow::none}, view);
}

}  // namespace kiln::test
