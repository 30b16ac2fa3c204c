// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <span>
#include <string>
#include <tbb/parallel_for.h>
#include <vector>

#include "asset/prt_asset.h"
#include "image/image.h"
#include "mesh/draco_file.h"

/// The files that a description names, read one by one and held against it. All throw BadInput.
namespace kiln {

/// The mesh of an asset with an atlas, fit to be drawn.
TriangleMesh read_atlas_mesh(const std::filesystem::path& folder, const PrtDescription& asset);

/// The mesh of an asset baked per vertex, fit to be drawn, with its attributes.
AttributedMesh read_vertex_mesh(const std::filesystem::path& folder, const PrtDescription& asset);

/// The attribute of that mesh that has plane `k`, with as many bits and components as it needs.
const IntegerAttribute& attribute_of(const AttributedMesh& mesh, const std::filesystem::path& folder,
                                     const PrtDescription& asset, std::size_t k);

/// Values of a plane at some vertices, from its attribute.
std::vector<float> vertex_values(const IntegerAttribute& attribute, const PrtPlane& plane,
                                 std::span<const std::uint32_t> vertices);

/// Throws unless a picture has that size and so many channels, 1 or 3.
template <class Texel>
void require_picture(const Image<Texel>& picture, const std::filesystem::path& file, int width, int height,
                     int channels, const std::string& remedy);

/// The picture of albedo, where the asset has one.
Image<std::uint8_t> read_albedo_picture(const std::filesystem::path& folder, const PrtDescription& asset);

/// Means and basis vectors of a compressed asset, as PrtClusters has them.
std::vector<float> read_vectors(const std::filesystem::path& folder, const PrtDescription& asset);

/// The cluster of every texel of a compressed asset, all of which are there; empty where there is one.
Image<std::uint8_t> read_cluster_ids(const std::filesystem::path& folder, const PrtDescription& asset);

/// A grey PNG of 8 or 16 bits and of that size.
template <class Texel>
Image<Texel> read_grey(const std::filesystem::path& file, int width, int height, const std::string& remedy);

template <>
Image<std::uint8_t> read_grey(const std::filesystem::path& file, int width, int height, const std::string& remedy);
template <>
Image<std::uint16_t> read_grey(const std::filesystem::path& file, int width, int height, const std::string& remedy);

/// The pictures of all planes, which have the bits of `Texel`. The first plane at fault is the one that is told of,
/// whatever the number of threads.
template <class Texel>
std::vector<Image<Texel>> read_grey_pictures(const std::filesystem::path& folder, const PrtDescription& asset,
                                             const std::string& remedy) {
  std::vector<Image<Texel>> pictures(asset.planes.size());
  std::vector<std::exception_ptr> faults(asset.planes.size());
  tbb::parallel_for(std::size_t{0}, pictures.size(), [&](std::size_t k) {
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

}  // namespace kiln
