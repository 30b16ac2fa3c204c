// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>

/// Names, keys and numbers of the asset format. docs/format.md is the specification; no other code spells them.
namespace kiln {

/// Versions that Kiln reads; it writes the newest. A file of a later version is refused. Features that a reader of the
/// same version might not know are listed under `requires`.
inline constexpr int oldest_format_version = 1;
inline constexpr int format_version = 2;

/// Values of the keys `format` and `basis`.
inline constexpr const char* prt_format = "kiln-prt";
inline constexpr const char* pca_format = "kiln-prt-pca";
inline constexpr const char* probes_format = "kiln-probes";
inline constexpr const char* basis_name = "real-sh-orthonormal";  ///< the basis of sh/basis.h

/// Files that describe a folder.
inline constexpr const char* ranges_name = "ranges.json";         ///< of a baked folder
inline constexpr const char* pca_name = "pca.json";               ///< of a compressed folder
inline constexpr const char* probes_json_name = "matrices.json";  ///< of a folder of probes

/// Files named by a description, with the names that Kiln gives them; a reader takes the names from the JSON.
inline constexpr const char* atlas_mesh_name = "atlas.drc";
inline constexpr const char* vertex_mesh_name = "vertices.drc";
inline constexpr const char* normal_map_name = "normal.png";
inline constexpr const char* albedo_map_name = "albedo.png";
inline constexpr const char* measured_map_name = "measured.png";
inline constexpr const char* opacity_map_name = "opacity.png";
inline constexpr const char* vectors_name = "vectors.png";
inline constexpr const char* cluster_ids_name = "clusters.png";
inline constexpr const char* matrices_png_name = "matrices.png";

/// Makes the name of a coefficient's picture: "coeff_0_07.png" is coefficient 7 of channel 0.
std::string plane_file(int channel, int coefficient);

/// Makes the name of the mesh of a level of detail: "lod_1.drc" is the first that is coarser than the mesh itself.
std::string level_file(int level);

/// Makes the name of a picture of weights: "weight_03.png" holds those of basis vector 3 of a compressed asset.
std::string weight_file(int component);

/// Makes the name of a vertex attribute: "kiln-prt-0-1" holds coefficients 4 to 7 of channel 0 of an asset baked per
/// vertex.
std::string plane_attribute(int channel, int group);
inline constexpr int attribute_components = 4;  ///< coefficients per attribute: a shader's vec4

/// Tests whether `name` is one that level_file makes.
bool is_level_name(const std::string& name);

/// Tests whether `name` is one that Kiln gives to planes, weights or tables, in any run.
bool is_plane_name(const std::string& name);

/// Keys of the JSON files.
namespace key {
inline constexpr const char* format = "format";
inline constexpr const char* version = "version";
inline constexpr const char* required = "requires";
inline constexpr const char* bands = "bands";
inline constexpr const char* channels = "channels";
inline constexpr const char* bits = "bits";
inline constexpr const char* width = "width";
inline constexpr const char* height = "height";
inline constexpr const char* vertices = "vertices";
inline constexpr const char* basis = "basis";
inline constexpr const char* mesh = "mesh";
inline constexpr const char* normals = "normals";
inline constexpr const char* normal_space = "normal_space";
inline constexpr const char* normal_width = "normal_width";
inline constexpr const char* normal_height = "normal_height";
inline constexpr const char* albedo = "albedo";
inline constexpr const char* albedo_width = "albedo_width";
inline constexpr const char* albedo_height = "albedo_height";
inline constexpr const char* opacity = "opacity";
inline constexpr const char* reflectance = "reflectance";
inline constexpr const char* reflectances = "reflectances";
inline constexpr const char* measured = "measured";
inline constexpr const char* name = "name";
inline constexpr const char* first_nm = "first_nm";
inline constexpr const char* step_nm = "step_nm";
inline constexpr const char* values = "values";
inline constexpr const char* spectrum = "spectrum";
inline constexpr const char* wavelengths_nm = "wavelengths_nm";
inline constexpr const char* lamps = "lamps";
inline constexpr const char* xyz = "xyz_from_channels";
inline constexpr const char* maps = "maps";
inline constexpr const char* unit = "unit";
inline constexpr const char* origin = "origin";
inline constexpr const char* levels = "levels";
inline constexpr const char* triangles = "triangles";
inline constexpr const char* error = "error";
inline constexpr const char* distance = "distance";
inline constexpr const char* planes = "planes";
inline constexpr const char* file = "file";
inline constexpr const char* attribute = "attribute";
inline constexpr const char* unique_id = "unique_id";
inline constexpr const char* component = "component";
inline constexpr const char* channel = "channel";
inline constexpr const char* coefficient = "coefficient";
inline constexpr const char* lowest = "min";
inline constexpr const char* highest = "max";
inline constexpr const char* clusters = "clusters";
inline constexpr const char* components = "components";
inline constexpr const char* cluster_ids = "cluster_ids";
inline constexpr const char* coefficient_scales = "coefficient_scales";
inline constexpr const char* vectors_file = "vectors_file";
inline constexpr const char* vector_ranges = "vector_ranges";
inline constexpr const char* grid = "grid";
inline constexpr const char* size = "size";
inline constexpr const char* lower = "lower";
inline constexpr const char* upper = "upper";
inline constexpr const char* positions = "positions";
inline constexpr const char* invalid = "invalid";
inline constexpr const char* matrices_file = "matrices_file";
inline constexpr const char* ranges = "ranges";
}  // namespace key

/// Entries of `requires`: features that a reader of the base form (textured planes, normals in object space, no albedo,
/// an opaque surface) would misread without knowing them.
namespace requirement {
inline constexpr const char* albedo = "albedo";
inline constexpr const char* albedo_size = "albedo_size";
inline constexpr const char* normal_size = "normal_size";
inline constexpr const char* opacity = "opacity";
inline constexpr const char* spectrum = "spectrum";
inline constexpr const char* tangent_normals = "tangent_normals";
inline constexpr const char* vertices = "vertices";
}  // namespace requirement

/// Bounds of the numbers in the files.
inline constexpr int most_asset_bands = 24;
inline constexpr int most_asset_channels = 64;
inline constexpr int largest_asset_side = 16384;
inline constexpr int most_asset_vertices = 1 << 30;
inline constexpr int most_clusters = 256;
inline constexpr int most_asset_triangles = 1 << 30;
inline constexpr int most_levels = 16;
inline constexpr int shortest_wavelength_nm = 100;
inline constexpr int longest_wavelength_nm = 2000;
inline constexpr int widest_reflectance_step_nm = 20;
inline constexpr int most_reflectances = 255;  ///< of one asset, whose map has bytes
inline constexpr int fewest_wavelengths = 4;   ///< channels that are wavelengths: three would pass for colours
inline constexpr int most_probe_bands = 8;
inline constexpr std::size_t most_probes = 1u << 18;
inline constexpr int largest_probe_grid = 1024;

/// Range compression of a plane's values: stored = round((x - lowest) / (highest - lowest) * (2^bits - 1)); if both
/// bounds are equal, every stored value is 0 ([Chapter 2010], 4.2.7).
struct PlaneRange {
  double lowest = 0;
  double highest = 0;

  /// Makes the range whose neighbouring stored values of `bits` are `step` apart.
  static PlaneRange of_steps(double lowest, double step, int bits) {
    return {lowest, lowest + step * largest_stored(bits)};
  }

  double width() const { return highest - lowest; }

  /// Returns the difference between the values of neighbouring stored numbers.
  double step(int bits) const { return width() / largest_stored(bits); }

  /// Returns the stored number of `value`, which is clamped to the range.
  std::uint32_t store(double value, int bits) const {
    if (!(highest > lowest)) return 0;
    const double place = (value - lowest) / width();
    return static_cast<std::uint32_t>(std::lround(std::clamp(place, 0.0, 1.0) * largest_stored(bits)));
  }

  /// Returns the value of a stored number, 0 to 2^bits - 1.
  double recover(std::uint32_t stored, int bits) const { return lowest + stored / largest_stored(bits) * width(); }

  static double largest_stored(int bits) { return (1u << bits) - 1; }
};

/// Finds the range of at least one value.
PlaneRange range_of(std::span<const float> values);

}  // namespace kiln
