// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "maps/detail_maps.h"
#include "mesh/surface_point.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Slots around a place of the low mesh, with their weights in a lookup: texels, bilinearly, or the vertices of a
/// triangle, the fourth of weight 0.
struct Lookup {
  std::array<std::uint32_t, 4> slots;
  std::array<float, 4> weights;
  bool at_border = false;  ///< whether a texel, or a neighbour of one, is covered by no chart
};

/// Points of an asset as viewers see them, pixel after pixel.
struct ErrorSamples {
  std::vector<Eigen::Vector3f> seen_positions, seen_normals;    ///< where the viewer's ray meets the high mesh
  std::vector<Eigen::Vector3f> stood_positions, stood_normals;  ///< points that those of the low mesh stand for
  std::vector<SurfacePoint> seen, stood;                        ///< both, in the high mesh
  std::vector<Eigen::Vector2f> uvs;                             ///< of the low mesh's points; empty where it has none
  std::vector<Lookup> lookups;                                  ///< in the low mesh's texture, or of its vertices
  std::vector<Lookup> vertex_lookups;                           ///< of its vertices
  std::vector<std::size_t> pixel_ends;                          ///< for each pixel the index after its last point
  std::vector<double> pixel_weights;                            ///< candidates that each pixel stands for

  std::size_t points() const { return lookups.size(); }
  std::size_t pixels() const { return pixel_ends.size(); }
};

/// Lists the slots that are looked up, each once, sorted.
std::vector<std::uint32_t> slots_of(const std::vector<Lookup>& lookups);

/// Wishes for samples.
struct ErrorSampling {
  std::size_t pixels = 4096;  ///< pixels wanted; fewer where most of the surface hides itself
  double pixel_size = 0;      ///< side of a pixel on the asset, object units; 0: pixels are points
  std::uint64_t seed = 1;
};

/// Spreads pixels evenly over the low mesh, by area, each seen from a direction of its own, by the cosine. Where pixels
/// have a size, each has several points spread over it, across the view. Pixels whose middle the low mesh hides, and
/// those not wholly covered by both meshes, are left out, as where pictures are compared.
///
/// Pixels along outlines within the picture, where the high mesh shows another part than the low one, are one in a
/// thousand and decide the error of a good asset. So rays look at many candidates, and a pixel is chosen with a
/// probability proportional to a guess of its error, and counts as the inverse of it: [Cochran 1977], chapter 9A.
///
/// Without `detail` the vertices of the low mesh are looked up.
ErrorSamples make_error_samples(const TriangleMesh& high, const TriangleMesh& low, const DetailMaps* detail,
                                const ErrorSampling& sampling);

}  // namespace kiln
