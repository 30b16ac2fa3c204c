#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <string>
#include <tbb/parallel_for.h>
#include <vector>

#include "asset/fields.h"
#include "asset/prt_asset.h"
#include "image/image.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

inline constexpr int most_asset_bands = 24;
inline constexpr int most_asset_channels = 64;
inline constexpr int largest_asset_side = 16384;

/// The mesh of an asset, fit to be drawn. Throws BadInput.
TriangleMesh read_asset_mesh(const std::filesystem::path& file);

/// The normal map that a folder names, if it does, and its space. Shading by transfer does not read it.
void read_normals(const Fields& fields, PrtAsset& asset);

/// Throws BadInput unless the mesh of `file` is fit to be drawn: its triangles' vertices are there, and it has a size.
void require_drawable(const TriangleMesh& mesh, const std::filesystem::path& file);

/// Of an asset baked per vertex: the mesh, and the transfer vectors decoded from its attributes, of which `planes`, as
/// many as there are coefficients, has one component each. Throws BadInput.
void read_vertex_transfer(const std::filesystem::path& folder, const Fields& fields, PrtAsset& asset);

/// A grey PNG of 8 or 16 bits and of that size. Throws BadInput.
template <class Texel>
Image<Texel> read_grey(const std::filesystem::path& file, int width, int height, const std::string& remedy);

template <>
Image<std::uint8_t> read_grey(const std::filesystem::path& file, int width, int height, const std::string& remedy);
template <>
Image<std::uint16_t> read_grey(const std::filesystem::path& file, int width, int height, const std::string& remedy);

/// `albedo` of the JSON that describes an asset of that size: the name of an sRGB-encoded picture, or three linear
/// numbers of 0 to 1; left out where it is not known. Throws BadInput.
PrtAlbedo read_albedo(const Fields& fields, const std::filesystem::path& folder, int width, int height,
                      const std::string& remedy);

/// All planes of an asset. The first plane at fault is the one that is told of, whatever the number of threads.
template <class Texel>
std::vector<Image<Texel>> read_grey_pictures(const std::filesystem::path& folder, const std::vector<std::string>& files,
                                             int width, int height, const std::string& remedy) {
  std::vector<Image<Texel>> pictures(files.size());
  std::vector<std::exception_ptr> faults(files.size());
  tbb::parallel_for(std::size_t{0}, pictures.size(), [&](std::size_t k) {
    try {
      pictures[k] = read_grey<Texel>(folder / files[k], width, height, remedy);
    } catch (...) {
      faults[k] = std::current_exception();
    }
  });
  for (const std::exception_ptr& fault : faults)
    if (fault) std::rethrow_exception(fault);
  return pictures;
}

}  // namespace kiln
