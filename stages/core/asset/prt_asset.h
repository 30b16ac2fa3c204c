// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "asset/format.h"
#include "detail/normal_space.h"
#include "image/image.h"
#include "mesh/triangle_mesh.h"
#include "sh/transfer.h"

namespace kiln {

/// One coefficient of one channel, or, in a compressed asset, the weights of one basis vector.
struct PrtPlane {
  std::string file;  ///< its picture, relative to the asset's folder; empty: an attribute of the mesh has it
  int channel = 0;
  int coefficient = 0;  ///< in a compressed asset the number of the basis vector
  PlaneRange range;
  int bits = 8;                 ///< of a stored value, 8 or 16
  std::string attribute = {};   ///< of the mesh of an asset baked per vertex
  std::uint32_t unique_id = 0;  ///< that Draco gave the attribute
  int component = 0;            ///< of the attribute
};

/// What makes transfer vectors of the weights of a compressed asset: of each cluster of texels a mean and the vectors
/// that the weights stand before. A transfer vector is all channels' coefficients, channel after channel.
struct PrtClusters {
  int count = 1;
  int components = 0;          ///< weights per texel
  int length = 0;              ///< of a transfer vector: channels * bands^2
  std::vector<float> vectors;  ///< per cluster its mean, then its `components` basis vectors
  Image<std::uint8_t> ids;     ///< the cluster of every texel; empty where there is one

  /// `component` of 0 to components - 1; mean() is M_k, vector() B_kj of D3DX' equation.
  std::span<const float> mean(int cluster) const { return row(cluster * (components + 1)); }
  std::span<const float> vector(int cluster, int component) const {
    return row(cluster * (components + 1) + 1 + component);
  }
  int of_texel(std::size_t texel) const { return count == 1 ? 0 : ids.values()[texel]; }

 private:
  std::span<const float> row(int k) const {
    return {vectors.data() + static_cast<std::size_t>(k) * static_cast<std::size_t>(length),
            static_cast<std::size_t>(length)};
  }
};

/// The share of light that the asset's surface reflects, which its transfer leaves out: exit radiance is this times
/// the sum of light and transfer coefficients.
struct PrtAlbedo {
  bool known = false;     ///< whether the asset says anything of it; if not, a grey of the consumer's choice will do
  std::string file = {};  ///< of the picture, relative to the asset's folder; empty: none
  Image<std::uint8_t> picture = {};  ///< 3 channels, sRGB-encoded, of the asset's size; empty where it is constant
  Eigen::Vector3f constant = Eigen::Vector3f::Ones();  ///< linear; where there is no picture
  bool within_transfer = false;  ///< whether a bake has multiplied transfer by it, which leaves ones here

  /// Returns the linear albedo of a texel, j * width + i; ones where it is not known.
  Eigen::Vector3f at(std::size_t texel) const;

  static PrtAlbedo of_constant(const Eigen::Vector3f& linear) { return {true, "", {}, linear}; }
  static PrtAlbedo of_picture(const std::string& name) { return {true, name}; }
  static PrtAlbedo of_transfer() { return {true, "", {}, Eigen::Vector3f::Ones(), true}; }
};

/// What pca.json says of the means and basis vectors; PrtClusters has them decoded.
struct PcaTables {
  int clusters = 1;
  std::string ids_file;                    ///< the cluster of every texel; empty where there is one
  std::string vectors_file;                ///< means and basis vectors
  std::vector<double> coefficient_scales;  ///< what entry i of a stored vector is multiplied by
  std::vector<PlaneRange> vector_ranges;   ///< of the means, then of each basis vector
};

/// All that the JSON of a baked folder says, and nothing of the files that it names. Planes of coefficients are sorted
/// by channel, then coefficient, and there is one for each; of weights, `coefficient` is the number of the basis
/// vector.
struct PrtDescription {
  std::filesystem::path ranges_file = {};            ///< where it comes from, for messages
  std::string mesh_file = {};                        ///< relative to its folder
  std::string normals_file = {};                     ///< the same; empty: none
  NormalSpace normal_space = NormalSpace::object;    ///< of that map
  PrtAlbedo albedo = {};                             ///< without its picture
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of the mesh's positions, in the coordinates of the file
  int bands = 0;
  int channels = 0;
  int bits = 8;  ///< 8 or 16, of stored values; of a compressed asset the most of any plane
  int width = 0;
  int height = 0;
  int vertices = 0;  ///< of an asset baked per vertex alone, whose width and height are 0
  std::vector<PrtPlane> planes = {};
  std::optional<PcaTables> pca = {};  ///< of a compressed asset alone

  /// Numbers of a transfer vector: all channels' coefficients, channel after channel.
  std::size_t vector_length() const {
    return static_cast<std::size_t>(channels) * static_cast<std::size_t>(bands) * static_cast<std::size_t>(bands);
  }
};

/// A baked PRT folder, as it is on the disk: the mesh with its atlas, and a picture for every transfer coefficient, or
/// for every weight where it is compressed. One that is baked per vertex has transfer vectors in place of pictures.
struct PrtAsset : PrtDescription {
  TriangleMesh mesh;
  std::variant<std::vector<Image<std::uint8_t>>, std::vector<Image<std::uint16_t>>> pictures;  ///< as `bits` says
  std::optional<PrtClusters> clusters;  ///< of a compressed asset alone
  std::vector<float> vertex_transfer;   ///< of one baked per vertex alone: a vector for each vertex of `mesh`

  bool is_per_vertex() const { return !vertex_transfer.empty(); }
};

/// Reads `folder`/pca.json, or where there is none `folder`/ranges.json, and what it names: the mesh, the planes and
/// the albedo, and nothing else. Throws BadInput where anything is missing, damaged, at odds with the rest, or beyond
/// this version of Kiln.
PrtAsset load_prt_asset(const std::filesystem::path& folder);

/// Reads the JSON alone, by the same rules.
PrtDescription load_prt_description(const std::filesystem::path& folder);

/// Reads another form of `asset`, as kiln-compress makes it. Throws BadInput as load_prt_asset does, and where it has
/// other bands.
PrtAsset load_other_form(const std::filesystem::path& folder, const PrtAsset& asset);

/// Transfer vectors of texels (numbered as Image has them), one after another: what planes, or weights and clusters,
/// stand for. `vectors` has room for channels * bands^2 values for each texel.
void decode_transfer(const PrtAsset& asset, std::span<const std::uint32_t> texels, std::span<float> vectors);

/// Transfer at some places of a folder of kiln-bake: texels (numbered as Image has them), or vertices of its mesh. Goes
/// plane by plane, so that of the pictures one is in memory. Throws BadInput.
std::vector<TransferVectors> read_transfer(const std::filesystem::path& folder, std::span<const std::uint32_t> places);

}  // namespace kiln
