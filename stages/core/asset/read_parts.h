// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "image/image.h"
#include "mesh/draco_file.h"

/// Readers of the files that a description names; each checks its file against the description and throws BadInput.
namespace kiln {

/// Reads the mesh of an asset with an atlas, and checks that it can be drawn.
TriangleMesh read_atlas_mesh(const std::filesystem::path& folder, const PrtDescription& asset);

/// Reads the mesh of a level of detail, and checks it against its description.
TriangleMesh read_level_mesh(const std::filesystem::path& folder, const PrtDescription& asset, const PrtLevel& level);

/// Reads the mesh of an asset baked per vertex with its attributes, and checks that it can be drawn.
AttributedMesh read_vertex_mesh(const std::filesystem::path& folder, const PrtDescription& asset);

/// Finds the attribute of that mesh that holds plane `k`, and checks its bits and components.
const IntegerAttribute& attribute_of(const AttributedMesh& mesh, const std::filesystem::path& folder,
                                     const PrtDescription& asset, std::size_t k);

/// Reads the values of a plane at some vertices from its attribute.
std::vector<float> vertex_values(const IntegerAttribute& attribute, const PrtPlane& plane,
                                 std::span<const std::uint32_t> vertices);

/// Throws unless a picture has the given size and 1 or 3 channels.
template <class Texel>
void require_picture(const Image<Texel>& picture, const std::filesystem::path& file, int width, int height,
                     int channels, const std::string& remedy);

/// Reads the picture of the numbers of measured reflectances, if the asset has one. Throws BadInput for a number that
/// none has.
Image<std::uint8_t> read_measured_picture(const std::filesystem::path& folder, const PrtDescription& asset);

/// Reads the picture of the albedo, if the asset has one.
Image<std::uint8_t> read_albedo_picture(const std::filesystem::path& folder, const PrtDescription& asset);

/// Reads the picture of the opacity, of any size, if the asset has one.
Image<std::uint8_t> read_opacity_picture(const std::filesystem::path& folder, const PrtDescription& asset);

/// Reads the means and basis vectors of a compressed asset, laid out as in PrtClusters.
std::vector<float> read_vectors(const std::filesystem::path& folder, const PrtDescription& asset);

/// Reads the cluster of every texel of a compressed asset, each of which must exist; empty if there is only one.
Image<std::uint8_t> read_cluster_ids(const std::filesystem::path& folder, const PrtDescription& asset);

/// Reads a grey PNG of 8 or 16 bits and of the given size.
template <class Texel>
Image<Texel> read_grey(const std::filesystem::path& file, int width, int height, const std::string& remedy);

template <>
Image<std::uint8_t> read_grey(const std::filesystem::path& file, int width, int height, const std::string& remedy);
template <>
Image<std::uint16_t> read_grey(const std::filesystem::path& file, int width, int height, const std::string& remedy);

/// Reads the pictures of all planes, whose bits are those of `Texel`. With several faults the first plane's is
/// reported, on any number of threads.
template <class Texel>
std::vector<Image<Texel>> read_grey_pictures(const std::filesystem::path& folder, const PrtDescription& asset,
                                             const std::string& remedy);

}  // namespace kiln
