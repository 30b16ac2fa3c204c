// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "image/image.h"
#include "maps/normal_space.h"
#include "mesh/triangle_mesh.h"
#include "mesh/uv_raster.h"

namespace kiln {

/// Maps that the normals stage writes: for every texel of an atlas, the point of the high mesh that it stands for.
struct DetailMaps {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> covered;                ///< 1 or 0 per texel, rows from the bottom
  Image<float> position;                            ///< 3 channels, in the atlas's frame; gutters filled
  Image<float> normal_object;                       ///< 3 channels, unit vectors in object space; gutters filled
  NormalSpace normal_space = NormalSpace::object;   ///< space of the map in the file
  int own_normal_width = 0, own_normal_height = 0;  ///< texels of the normal map that ships; 0: this one does
  Image<float> albedo;                              ///< 3 channels, linear, gutters filled; empty where it is constant
  int albedo_width = 0, albedo_height = 0;  ///< texels of its file, from which `albedo` is resized where they differ
  Eigen::Vector3f constant_albedo = Eigen::Vector3f::Ones();  ///< linear; used where `albedo` is empty
  bool albedo_known = false;                                  ///< the normals stage found an albedo or was given one
  bool has_opacity = false;  ///< the surface is not opaque everywhere: the folder has a map of its opacity

  /// Returns the linear albedo of a texel.
  Eigen::Vector3f albedo_at(int i, int j) const;
};

/// Returns 1 per covered texel, else 0, rows from the bottom.
std::vector<std::uint8_t> coverage_of(const UvRaster& raster);

/// Makes a map in `space` from unit vectors in object space (3 channels, one per covered texel of `raster`), with
/// gutters filled. `atlas` has normals and uvs; `raster` is the atlas's own, or the same with further texels that have
/// a place in it.
Image<float> normal_map(const Image<float>& normal_object, NormalSpace space, const TriangleMesh& atlas,
                        const UvRaster& raster);

/// Normalises all vectors of a map in `space`; zero vectors become +Z in tangent space, else +Y.
void normalise(Image<float>& map, NormalSpace space);

/// Encodes a map of unit vectors as normal.png holds it, n * 0.5 + 0.5 of 65,535.
Image<std::uint16_t> quantise_normals(const Image<float>& map);
Image<float> dequantise_normals(const Image<std::uint16_t>& encoded);

/// Decodes normal.png to unit vectors in object space, with gutters filled.
Image<float> decode_normals(const Image<std::uint16_t>& encoded, NormalSpace space, const TriangleMesh& atlas,
                            const UvRaster& raster);

/// Reads normals.json, coverage.png, position.exr and normal.png of a folder that the normals stage made from `atlas`
/// (decoded, with normals and uvs). Throws BadInput where one is missing or damaged, where sizes disagree, or where the
/// coverage is not that of `atlas`.
DetailMaps load_detail_maps(const std::filesystem::path& folder, const TriangleMesh& atlas);

}  // namespace kiln
