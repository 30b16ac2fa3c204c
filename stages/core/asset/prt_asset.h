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
#include "image/image.h"
#include "maps/normal_space.h"
#include "mesh/triangle_mesh.h"
#include "sh/transfer.h"

namespace kiln {

/// One coefficient of one channel or, in a compressed asset, the weights of one basis vector.
struct PrtPlane {
  std::string file;  ///< picture, relative to the asset's folder; empty if an attribute of the mesh holds the plane
  int channel = 0;
  int coefficient = 0;  ///< in a compressed asset, the number of the basis vector
  PlaneRange range;
  int bits = 8;                 ///< bits of a stored value, 8 or 16
  std::string attribute = {};   ///< attribute of the mesh of an asset baked per vertex
  std::uint32_t unique_id = 0;  ///< the attribute's id in the Draco file
  int component = 0;            ///< component of the attribute
};

/// Means and basis vectors of a compressed asset, which turn a texel's weights into its transfer vector: each cluster
/// of texels has one mean and one basis vector per weight. A transfer vector holds all channels' coefficients, channel
/// after channel.
struct PrtClusters {
  int count = 1;
  int components = 0;          ///< weights per texel
  int length = 0;              ///< numbers of a transfer vector: channels * bands^2
  std::vector<float> vectors;  ///< for each cluster its mean, then its `components` basis vectors
  Image<std::uint8_t> ids;     ///< the cluster of every texel; empty if there is only one cluster

  /// Vectors of a cluster: mean() is M_k, vector() is B_kj of [D3DX]'s equation; `component` is 0 to components - 1.
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

/// Measured reflectance of a surface, or of one of its materials, at even wavelengths; linear between them, and beyond
/// their ends as at them.
struct PrtReflectance {
  std::string name = {};
  int first_nm = 0;
  int step_nm = 1;
  std::vector<double> values = {};  ///< 0 to 1

  bool operator==(const PrtReflectance&) const = default;
};

/// Wavelengths that the channels of transfer are of, one each, and how lamps show them.
struct PrtSpectrum {
  /// Lamp, and the matrix that reads X, Y and Z from what comes back of the wavelengths, all of 1.
  struct Lamp {
    std::string name = {};
    std::vector<std::vector<double>> xyz_from_channels = {};  ///< three rows
  };

  std::vector<int> wavelengths_nm = {};  ///< rising
  std::vector<Lamp> lamps = {};
};

/// Reflectance of the asset's surface, which its transfer does not include: exit radiance is albedo times the sum of
/// light and transfer coefficients.
struct PrtAlbedo {
  bool known = false;                  ///< whether the asset states its albedo; if not, consumers choose a grey
  std::string file = {};               ///< the picture, relative to the asset's folder; empty if there is none
  int width = 0, height = 0;           ///< texels of the picture where they are not those of the planes; else 0
  Image<std::uint8_t> picture = {};    ///< 3 channels, sRGB-encoded; empty if constant
  Image<std::uint8_t> at_planes = {};  ///< the same at the size of the planes, where that is another
  Eigen::Vector3f constant = Eigen::Vector3f::Ones();  ///< linear; used if there is no picture
  std::optional<PrtReflectance> reflectance = {};      ///< where it was measured; `constant` is its colour under D65
  std::vector<PrtReflectance> reflectances = {};       ///< of materials that were measured
  std::string measured_file = {};        ///< the picture of their numbers, relative to the asset's folder; empty: none
  Image<std::uint8_t> measured_at = {};  ///< at the size of the planes: 0 where nothing was measured, else the number
                                         ///< of the reflectance, from 1; empty where there are none
  bool within_transfer = false;          ///< whether the bake has multiplied transfer by albedo, which is 1 here then

  /// Returns the linear albedo of a texel, j * width + i; ones where it is not known.
  Eigen::Vector3f at(std::size_t texel) const;

  /// Returns the measured reflectance of a texel of the planes; null where only its albedo is known.
  const PrtReflectance* measured(std::size_t texel) const;

  bool has_own_size() const { return width > 0; }

  static PrtAlbedo of_constant(const Eigen::Vector3f& linear) { return {.known = true, .constant = linear}; }
  static PrtAlbedo of_picture(const std::string& name) { return {.known = true, .file = name}; }
  static PrtAlbedo of_transfer() { return {.known = true, .within_transfer = true}; }
};

/// Description of the means and basis vectors in pca.json; PrtClusters has them decoded.
struct PcaTables {
  int clusters = 1;
  std::string ids_file;      ///< picture with the cluster of every texel; empty if there is only one cluster
  std::string vectors_file;  ///< picture of means and basis vectors
  std::vector<double> coefficient_scales;  ///< factor of entry i of a stored vector
  std::vector<PlaneRange> vector_ranges;   ///< range of the means, then of each basis vector
};

/// A further map for materials, which ships beside what transfer needs.
struct PrtMap {
  std::string name;  ///< what it holds: "ao", "roughness", ... (stages/normals/README.md)
  std::string file;  ///< PNG, or EXR of floats; relative to the asset's folder, looked up with the mesh's uvs
  /// Values that a PNG stores as 0 and as its largest number.
  std::optional<PlaneRange> range;
};

/// Coarser mesh of an asset with an atlas, with the same uvs, planes and normal map, to be drawn from afar. Readers may
/// ignore it.
struct PrtLevel {
  std::string mesh_file;  ///< relative to the JSON file's folder
  int triangles = 0;      ///< of that mesh, fewer than of the level before
  double error = 0;       ///< largest distance that a point of the surface has moved by, object units
  double distance = 0;    ///< from the camera to the centre of the asset's box, from which on to draw it, object units
};

/// Content of a baked folder's JSON, without the files that it names. Planes of coefficients are sorted by channel,
/// then coefficient, each there once; of planes of weights, `coefficient` is the number of the basis vector.
struct PrtDescription {
  std::filesystem::path ranges_file = {};          ///< the JSON file, for messages
  std::string mesh_file = {};                      ///< relative to the JSON file's folder
  std::string normals_file = {};                   ///< relative to the same folder; empty if there is none
  NormalSpace normal_space = NormalSpace::object;  ///< space of that normal map
  int normal_width = 0, normal_height = 0;         ///< texels of that map where they are not those of the planes
  PrtAlbedo albedo = {};                           ///< without its picture
  std::string opacity_file = {};                   ///< relative to the folder; empty: the surface is opaque
  std::vector<PrtMap> maps = {};                   ///< further maps
  /// origin of the mesh's positions, in the coordinates of the original file
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  int bands = 0;
  int channels = 0;
  int bits = 8;  ///< bits of stored values, 8 or 16; in a compressed asset the most that any plane has
  int width = 0;
  int height = 0;
  int vertices = 0;  ///< vertices of an asset baked per vertex, whose width and height are 0; else 0
  std::vector<PrtPlane> planes = {};
  std::optional<PcaTables> pca = {};         ///< set for compressed assets only
  std::optional<PrtSpectrum> spectrum = {};  ///< set where channels are wavelengths, not colours
  std::vector<PrtLevel> levels = {};         ///< levels of detail, the finest first; the mesh itself is not among them

  /// Returns the numbers of a transfer vector: all channels' coefficients, channel after channel.
  std::size_t vector_length() const {
    return static_cast<std::size_t>(channels) * static_cast<std::size_t>(bands) * static_cast<std::size_t>(bands);
  }
};

/// A baked folder in memory, values still as stored: the mesh with its atlas, and a picture for each transfer
/// coefficient (for each weight if compressed). An asset baked per vertex has transfer vectors instead of pictures.
struct PrtAsset : PrtDescription {
  TriangleMesh mesh;
  Image<std::uint8_t> opacity;  ///< 1 channel, of any size; nothing is there below 128; empty: opaque
  /// one per plane, 8 or 16 bits as `bits` says
  std::variant<std::vector<Image<std::uint8_t>>, std::vector<Image<std::uint16_t>>> pictures;
  std::optional<PrtClusters> clusters;  ///< set for compressed assets only
  /// set for assets baked per vertex only: one transfer vector per vertex of `mesh`
  std::vector<float> vertex_transfer;

  bool is_per_vertex() const { return !vertex_transfer.empty(); }
};

/// Reads `folder`/pca.json or, without it, `folder`/ranges.json, and the files that it names: mesh, planes and albedo.
/// Throws BadInput if anything is missing, damaged, inconsistent, or newer than this version of Kiln.
PrtAsset load_prt_asset(const std::filesystem::path& folder);

/// Reads the JSON alone, by the same rules.
PrtDescription load_prt_description(const std::filesystem::path& folder);

/// Reads the mesh of level `level` of detail: 0 is the asset's own, 1 the first of `asset.levels`. Throws BadInput for
/// a level that the asset does not have, and for a file that does not fit its description.
TriangleMesh load_level(const std::filesystem::path& folder, const PrtDescription& asset, int level);

/// Reads another form of `asset`, such as kiln-compress makes. Throws BadInput as load_prt_asset does, and for a
/// different number of bands.
PrtAsset load_other_form(const std::filesystem::path& folder, const PrtAsset& asset);

/// Decodes the transfer vectors of texels (numbered as Image numbers them), one after another, from planes or from
/// weights and clusters. `vectors` holds channels * bands^2 values per texel.
void decode_transfer(const PrtAsset& asset, std::span<const std::uint32_t> texels, std::span<float> vectors);

/// Reads transfer vectors at some points of a folder of kiln-bake: texels (numbered as Image numbers them) or vertices
/// of its mesh. Only one picture is in memory at a time. Throws BadInput.
std::vector<TransferVectors> read_transfer(const std::filesystem::path& folder, std::span<const std::uint32_t> places);

}  // namespace kiln
