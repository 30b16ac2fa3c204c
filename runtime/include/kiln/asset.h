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
using Colour = std::array<float, 3>;

/// Where an asset's transfer vectors stand.
enum class Form {
  texels,    ///< one picture for each coefficient
  clusters,  ///< compressed: pictures of weights, and the vectors that they weigh
  vertices,  ///< in attributes of the mesh
};

/// A folder that kiln-bake or kiln-compress made, in memory. Cheap to copy: copies share what was read. Points of the
/// surface are numbered: texels row after row from the bottom (v = 0), or vertices. docs/format.md has the meaning of
/// every number. Constant functions may be called from several threads at once.
class KILN_RUNTIME_API Asset {
 public:
  /// Reads the folder. Throws Error where anything is missing, damaged, or at odds with the rest.
  static Asset load(const std::filesystem::path& folder);

  Form form() const;
  int bands() const;     ///< degrees l < bands
  int channels() const;  ///< 1: the same transfer for all colours; 3: red, green, blue
  int width() const;     ///< texels; 0 where transfer stands at vertices
  int height() const;
  std::size_t points() const;         ///< width * height, or vertices
  std::size_t vector_length() const;  ///< numbers of a transfer vector: channels * bands^2

  /// The mesh, in object space (+Y up, right-handed): three numbers a vertex, two of uvs (0,0 the lower left; none
  /// where transfer stands at vertices), three vertices a triangle, counter-clockwise from outside.
  std::span<const float> positions() const;
  std::span<const float> normals() const;
  std::span<const float> uvs() const;
  std::span<const std::uint32_t> triangles() const;

  /// Where positions count from, in the coordinates of the file that the mesh was made of.
  std::array<double, 3> origin() const;

  /// Transfer vectors of points, one after another, each channel after channel. `vectors` holds vector_length() numbers
  /// for each point. Throws Error for a point that is none, or too short a span.
  void transfer(std::span<const std::uint32_t> points, std::span<float> vectors) const;

  /// Whether the asset says what share of light its surface reflects; if not, albedo() is 1.
  bool knows_albedo() const;
  Colour albedo(std::uint32_t point) const;

  /// For the library's own use.
  const PrtAsset& implementation() const { return *asset_; }

 private:
  explicit Asset(std::shared_ptr<const PrtAsset> asset);
  std::shared_ptr<const PrtAsset> asset_;
};

}  // namespace kiln::runtime
