// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

namespace kiln {

/// Format of a depth map's texel.
enum class ShadowDepth { float_32, fixed_24, fixed_16 };

/// Number of depth map texels that a receiver is compared with (percentage-closer filtering [Reeves 1987]). Visibility
/// is the mean of the comparisons, weighted by the B-spline of the filter's width around the receiver.
enum class ShadowFilter { nearest, two_by_two, three_by_three };

/// Surface of the occluders that a depth map holds.
enum class ShadowFaces {
  front,    ///< the first surface
  back,     ///< the first surface that faces away from the light (closed occluders; open ones: the first surface)
  midpoint  ///< halfway between these two [Woo 1992] (closed occluders; open ones: the first surface)
};

/// How the EGL engine decides whether a receiver is in shadow. A receiver at depth z (0 to 1 along the direction) is
/// lit where the map holds at least z - bias. The bias is the sum of
///   depth_bias                                   a constant, in depths (D3DX's ZBias [D3DX]); by default the rounding
///                                                of the occluders' positions (rounding_offset)
///   angle_bias_texels * texel * tan / extent     grows with the tangent of the angle between normal and direction
///                                                (D3DX's ZAngleBias), clamped to steepest_slope
///   half a step of the depth format              the largest rounding of a stored depth
struct ShadowMapSettings {
  int size_texels = 1024;  ///< width and height of the depth map of one direction
  ShadowDepth depth = ShadowDepth::float_32;
  std::optional<double> depth_bias;    ///< fraction of the occluders' extent along the direction; none: rounding_offset
  double angle_bias_texels = 0.25;     ///< texels of the depth map, times the tangent
  double normal_offset_texels = 0.25;  ///< shift of receivers along their normal, in texels of the depth map
  /// Compares each texel with the depth of the receiver's tangent plane at that texel's centre instead of with the
  /// receiver's own depth [Schueler 2005] [Isidoro 2006]; the plane's slope is clamped to steepest_slope.
  bool receiver_plane = true;
  ShadowFilter filter = ShadowFilter::nearest;
  ShadowFaces faces = ShadowFaces::front;
  /// Takes no shadow from the triangle that the receiver stands on, nor from those that share a corner with it
  /// [Hourcade 1985]. Needs ShadowRays::triangles_below.
  bool triangle_ids = false;
  /// Counts ambiguous pairs of a receiver and a direction: a texel that the filter reads holds a depth within the map's
  /// error band of the depth it is compared with, or the texels do not agree. The band is error_band_texels * texel *
  /// tan (clamped as above) plus a step of the depth format. Without receiver_plane and with no offset or bias almost
  /// every lit pair is ambiguous, because the map holds the receiver's own surface.
  bool count_ambiguous = false;
  double error_band_texels = 0.5;
  /// Decides the ambiguous pairs by rays. Needs ShadowRays::occluded; implies count_ambiguous and at least 2 x 2
  /// texels, which it takes to find them.
  bool refine = false;
  /// Skips tiles of receivers that a coarse map of least and greatest depths shows to be wholly lit or wholly shadowed
  /// (conservative regions of [US 7,948,490], section 5). Changes no result.
  bool regions = false;
  int batch_directions = 16;  ///< depth maps alive at a time; a divisor of block_directions
  bool layered_pass = true;   ///< draws all maps of a batch in one pass, where GL can; the result is the same

  static constexpr double steepest_slope = 8;  ///< tangent of 83 degrees, where a cosine weighs an eighth
};

}  // namespace kiln
