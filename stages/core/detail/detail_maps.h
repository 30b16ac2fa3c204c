#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "detail/normal_space.h"
#include "image/image.h"
#include "mesh/triangle_mesh.h"
#include "mesh/uv_raster.h"

namespace kiln {

/// What the normals stage found out about every texel of an atlas: the point of the high mesh that it stands for.
struct DetailMaps {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> covered;               ///< 1 or 0 per texel, rows from the bottom
  Image<float> position;                           ///< 3 channels, in the atlas's frame; gutters filled
  Image<float> normal_object;                      ///< 3 channels, unit vectors in object space; gutters filled
  NormalSpace normal_space = NormalSpace::object;  ///< of the map as it is in the file
  Image<float> albedo;                             ///< 3 channels, linear, gutters filled; empty where it is constant
  Eigen::Vector3f constant_albedo = Eigen::Vector3f::Ones();  ///< linear, where there is no map of it
  bool albedo_known = false;                                  ///< whether the normals stage found or was given one

  /// Linear, of a texel.
  Eigen::Vector3f albedo_at(int i, int j) const;
};

/// 1 per covered texel, else 0, rows from the bottom.
std::vector<std::uint8_t> coverage_of(const UvRaster& raster);

/// Unit vectors in object space (3 channels, one per covered texel of `raster`) as a map in `space`, gutters filled
/// there. `atlas` has normals and uvs; `raster` is its own, or that with more texels which have a place in it.
Image<float> normal_map(const Image<float>& normal_object, NormalSpace space, const TriangleMesh& atlas,
                        const UvRaster& raster);

/// Gives all vectors of a map in `space` length one; those without a length become +Z in tangent space, else +Y.
void normalise(Image<float>& map, NormalSpace space);

/// A map of unit vectors as normal.png holds it, n * 0.5 + 0.5 of 65,535, and back.
Image<std::uint16_t> quantise_normals(const Image<float>& map);
Image<float> dequantise_normals(const Image<std::uint16_t>& encoded);

/// normal.png as unit vectors in object space, gutters filled.
Image<float> decode_normals(const Image<std::uint16_t>& encoded, NormalSpace space, const TriangleMesh& atlas,
                            const UvRaster& raster);

/// Reads normals.json, coverage.png, position.exr and normal.png of a folder that the normals stage made from `atlas`
/// (decoded, with normals and uvs). Throws BadInput where one is missing or damaged, where sizes disagree, or where the
/// coverage is not that of `atlas`.
DetailMaps load_detail_maps(const std::filesystem::path& folder, const TriangleMesh& atlas);

}  // namespace kiln
