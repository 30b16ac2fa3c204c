// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "kiln/error.h"
#include "kiln/export.h"

namespace kiln {
struct PrtAsset;
}

namespace kiln::runtime {

/// Linear red, green and blue.
using Color = std::array<float, 3>;

/// How an asset stores its transfer vectors.
enum class Form {
  texels,    ///< for texels: one picture per coefficient
  clusters,  ///< for texels, compressed: pictures of weights, and the vectors that they multiply
  vertices,  ///< for vertices: in attributes of the mesh
};

/// An asset in memory, read from a folder of kiln-bake or kiln-compress. Cheap to copy, since copies share the data.
/// Points of the surface are numbered: texels row after row from the bottom (v = 0), or vertices. docs/format.md
/// explains every number. Constant functions may be called from several threads at once.
class KILN_RUNTIME_API Asset {
 public:
  /// Reads a folder. Throws Error if anything is missing, damaged or inconsistent.
  static Asset load(const std::filesystem::path& folder);

  Form form() const;
  int bands() const;     ///< number of degrees: l < bands
  int channels() const;  ///< 1: the same transfer for all colours; 3: red, green, blue
  int width() const;     ///< texels; 0 if transfer is stored at vertices
  int height() const;
  std::size_t points() const;         ///< width * height, or the number of vertices
  std::size_t vector_length() const;  ///< numbers of a transfer vector: channels * bands^2

  /// The mesh in object space (+Y up, right-handed): three numbers per vertex, two uvs per vertex ((0, 0) is the lower
  /// left; none if transfer is stored at vertices), three vertices per triangle, counter-clockwise seen from outside.
  std::span<const float> positions() const;
  std::span<const float> normals() const;
  std::span<const float> uvs() const;

  /// Two uvs per vertex that textures painted for the mesh use; none where they are uvs(), or not known. They may lie
  /// anywhere.
  std::span<const float> texture_uvs() const;
  std::span<const std::uint32_t> triangles() const;

  /// Returns the origin of positions, in the coordinates of the file that the mesh was made from.
  std::array<double, 3> origin() const;

  /// Writes the transfer vectors of points to `vectors`, one after another, each channel after channel. `vectors` holds
  /// vector_length() numbers per point. Throws Error for a point out of range or too short a span.
  void transfer(std::span<const std::uint32_t> points, std::span<float> vectors) const;

  /// Tests whether the asset states the reflectance of its surface; if not, albedo() is 1.
  bool knows_albedo() const;
  Color albedo(std::uint32_t point) const;

  /// The map of opacity, of 0 to 255, row after row from the bottom, looked up with uvs(): nothing is there where a
  /// bilinear lookup is below 127.5. Empty, of 0 x 0 texels, where the surface is opaque.
  std::span<const std::uint8_t> opacity() const;
  int opacity_width() const;
  int opacity_height() const;

  /// Returns the library's own representation.
  const PrtAsset& implementation() const { return *asset_; }

 private:
  explicit Asset(std::shared_ptr<const PrtAsset> asset);
  std::shared_ptr<const PrtAsset> asset_;
};

}  // namespace kiln::runtime
