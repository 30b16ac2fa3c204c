#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "detail/normal_space.h"
#include "image/image.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// One coefficient of one channel: stored values of 0 to 1 stand for `lowest` to `highest`.
struct PrtPlane {
  std::string file;
  int channel = 0;
  int coefficient = 0;
  double lowest = 0;
  double highest = 0;
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
  bool known = false;  ///< whether the asset says anything of it; if not, a grey of the consumer's choice will do
  std::string file;    ///< of the picture, relative to the asset's folder; empty: none
  Image<std::uint8_t> picture;  ///< 3 channels, sRGB-encoded, of the asset's size; empty where it is constant
  Eigen::Vector3f constant = Eigen::Vector3f::Ones();  ///< linear; where there is no picture
};

/// A baked PRT folder, as it is on the disk: the mesh with its atlas, and a picture for every transfer coefficient, or
/// for every weight where it is compressed. Planes of coefficients are sorted by channel, then coefficient, and there
/// is one for each; of weights, `coefficient` is the number of the basis vector. One that is baked per vertex has
/// transfer vectors in place of pictures, and width and height are 0.
struct PrtAsset {
  std::filesystem::path ranges_file;               ///< where it comes from, for messages
  std::string mesh_file;                           ///< relative to its folder
  std::string normals_file;                        ///< the same; empty: none
  NormalSpace normal_space = NormalSpace::object;  ///< of that map
  PrtAlbedo albedo;
  TriangleMesh mesh;
  int bands = 0;
  int channels = 0;
  int bits = 8;  ///< 8 or 16: which of the two kinds of picture `pictures` holds
  int width = 0;
  int height = 0;
  std::vector<PrtPlane> planes;
  std::variant<std::vector<Image<std::uint8_t>>, std::vector<Image<std::uint16_t>>> pictures;
  std::optional<PrtClusters> clusters;  ///< of a compressed asset alone
  std::vector<float> vertex_transfer;   ///< of one baked per vertex alone: a vector for each vertex of `mesh`

  /// Numbers of a transfer vector: all channels' coefficients, channel after channel.
  std::size_t vector_length() const {
    return static_cast<std::size_t>(channels) * static_cast<std::size_t>(bands) * static_cast<std::size_t>(bands);
  }
  bool is_per_vertex() const { return !vertex_transfer.empty(); }
};

inline constexpr const char* ranges_name = "ranges.json";  ///< of a baked folder
inline constexpr const char* pca_name = "pca.json";        ///< of a compressed one

/// Reads `folder`/pca.json, or where there is none `folder`/ranges.json, and what it names: the mesh, the planes and
/// the albedo, and nothing else. Throws BadInput where anything is missing, damaged, or at odds with the rest.
PrtAsset load_prt_asset(const std::filesystem::path& folder);

/// Reads a folder of kiln-compress; its README has the format.
PrtAsset load_pca_asset(const std::filesystem::path& folder);

/// Reads another form of `asset`, as kiln-compress makes it. Throws BadInput as load_prt_asset does, and where it has
/// other bands.
PrtAsset load_other_form(const std::filesystem::path& folder, const PrtAsset& asset);

/// Transfer vectors of texels (numbered as Image has them), one after another: what planes, or weights and clusters,
/// stand for. `vectors` has room for channels * bands^2 values for each texel.
void decode_transfer(const PrtAsset& asset, std::span<const std::uint32_t> texels, std::span<float> vectors);

}  // namespace kiln
