// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "sh/transfer.h"

namespace kiln {

/// What a texel of a depth map holds.
enum class ShadowDepth { float_32, fixed_24, fixed_16 };

/// How many texels of a depth map a receiver is compared with (percentage-closer filtering: Reeves, Salesin and Cook,
/// "Rendering antialiased shadows with depth maps", 1987). Visibility is the mean of the comparisons, weighted by the
/// B-spline of the filter's width about the receiver.
enum class ShadowFilter { nearest, two_by_two, three_by_three };

/// Which surface of the occluders a depth map holds.
enum class ShadowFaces {
  front,    ///< the first one
  back,     ///< the first that faces away from the light (closed occluders; others: the first one)
  midpoint  ///< halfway between these two (Woo, "The shadow depth map revisited", 1992; closed occluders, as above)
};

/// How the EGL engine decides whether a receiver is in shadow. A receiver at depth z (0 to 1 along the direction) is
/// lit where the map holds at least z - bias. The bias is made of
///   depth_bias                                   a constant, in depths (D3DX's ZBias); if none is given what the
///                                                precision of the positions asks for (rounding_offset)
///   angle_bias_texels * texel * tan / extent     grows with the tangent of the angle between normal and direction
///                                                (D3DX's ZAngleBias), which is clamped to steepest_slope
///   half a step of the depth format              what rounding may take
struct ShadowMapSettings {
  int size_texels = 1024;  ///< width and height of the depth map of one direction
  ShadowDepth depth = ShadowDepth::float_32;
  std::optional<double> depth_bias;    ///< fraction of the occluders' extent along the direction; none: rounding_offset
  double angle_bias_texels = 0.25;     ///< texels of the depth map, times the tangent
  double normal_offset_texels = 0.25;  ///< how far receivers are moved along their normal, in texels of the depth map
  /// Each texel is compared with the depth that the receiver's tangent plane has at that texel's centre, not with the
  /// receiver's own depth (Schueler 2005; Isidoro 2006); the plane's slope is clamped to steepest_slope.
  bool receiver_plane = true;
  ShadowFilter filter = ShadowFilter::nearest;
  ShadowFaces faces = ShadowFaces::front;
  /// A texel that shows the triangle the receiver stands on, or one that shares a corner with it, is no shadow
  /// (Hourcade and Nicolas, "Algorithms for antialiased cast shadows", 1985). Needs ShadowRays::triangles_below.
  bool triangle_ids = false;
  /// Looks for ambiguous pairs of a receiver and a direction and counts them: a texel that the filter reads holds a
  /// depth within the map's error band of the one it is compared with, or the texels do not agree. The band is
  /// error_band_texels * texel * tan (clamped as above) and a step of the depth format. Without receiver_plane and with
  /// no offset or bias almost every lit pair is ambiguous: its own surface is what the map holds.
  bool count_ambiguous = false;
  double error_band_texels = 0.5;
  /// Decides the ambiguous pairs by rays. Needs ShadowRays::occluded; implies count_ambiguous, and takes at least 2 x 2
  /// texels to tell them.
  bool refine = false;
  /// Tiles of receivers that a coarse map of least and greatest depths shows to be wholly lit or wholly shadowed are
  /// not tested (the patent's conservative regions, section 5). Changes no result.
  bool regions = false;
  int batch_directions = 16;  ///< depth maps alive at a time; block_directions is a multiple of it
  bool layered_pass = true;   ///< all maps of a batch in one pass, where GL can; the result is the same

  static constexpr double steepest_slope = 8;  ///< tangent of 83 degrees, where a cosine weighs an eighth
};

/// Receivers that are to be looked at from one direction.
struct ShadowRayQuery {
  Eigen::Vector3f direction;             ///< unit, towards the light
  std::vector<std::uint32_t> receivers;  ///< indices, rising
  std::vector<std::uint8_t> occluded;    ///< as many; the answer: 1 in shadow, 0 lit
};

/// What the EGL engine asks of a ray library, which it does not link (stages/bake/engines/shadow_rays.h has both).
struct ShadowRays {
  /// The triangle of the occluders that each receiver stands on.
  std::function<std::vector<std::uint32_t>(const Receivers&)> triangles_below;
  /// Answers each query.
  std::function<void(const Receivers&, std::span<ShadowRayQuery>)> occluded;
};

}  // namespace kiln
