// SPDX-License-Identifier: MIT
// Every receiver against the depth maps of a batch of directions: clamped cosine times visibility
// (stages/bake/engines/shadow_settings.h says what each option does).
//   TAPS            1, 2 or 3: so many texels a side are compared
//   STEEPEST_SLOPE  largest tangent of the angle between normal and direction that a slope or bias follows
//   RECEIVER_PLANE  1: a texel is compared with the receiver's tangent plane at the texel's centre
//   TRIANGLE_IDS    1: the receiver's own triangle and those around it cast no shadow on it
//   MIDPOINT        1: the depth is the mean of front and back faces
//   MARK            1: pairs that the map cannot decide get the sign bit, for stages/bake/egl/shadow_refine.h to take away
//   REGIONS         1: tiles of receivers that are wholly lit or shadowed are not tested
#include "bake_views.glsl"
#include "bake_receivers.glsl"

layout(std430, binding = 2) writeonly buffer Weights {
  float weights[];  // direction after direction
};
#if TRIANGLE_IDS == 1
layout(std430, binding = 5) readonly buffer ReceiverCorners {
  uvec4 receiver_corners[];  // xyz: the vertices of the triangle that the receiver stands on
};
layout(std430, binding = 6) readonly buffer TriangleCorners {
  uint triangle_corners[];  // three per triangle
};
layout(binding = 2) uniform usampler2DArray triangle_maps;
#endif

layout(binding = 0) uniform sampler2DArray depth_maps;
#if MIDPOINT == 1
layout(binding = 1) uniform sampler2DArray back_depth_maps;
#endif
uniform int batch_directions;
uniform int first_row;               // of the batch among the block's weights
uniform float depth_bias;            // in map depths, 0 to 1
uniform float position_bias;         // the same, in object units
uniform float angle_bias_texels;     // of the depth map
uniform float normal_offset_texels;  // of the depth map
uniform float error_band_texels;     // of the depth map
uniform float depth_rounding;        // in map depths

#if REGIONS == 1
#include "bake_tiles.glsl"
#endif

float stored_depth(ivec3 texel) {
#if MIDPOINT == 1
  return 0.5 * (texelFetch(depth_maps, texel, 0).r + texelFetch(back_depth_maps, texel, 0).r);
#else
  return texelFetch(depth_maps, texel, 0).r;
#endif
}

#if TRIANGLE_IDS == 1
bool is_neighbour(ivec3 texel, uvec3 own) {
  uint triangle = texelFetch(triangle_maps, texel, 0).r;
  if (triangle == 0xffffffffu) return false;
  bool shares = false;
  for (int k = 0; k < 3; ++k) {
    uint corner = triangle_corners[3u * triangle + uint(k)];
    shares = shares || any(equal(uvec3(corner), own));
  }
  return shares;
}
#endif

// Weights of the texels along one axis: the B-spline of TAPS texels. `fraction` is the place's from the first texel's
// centre (2 taps), or from the middle texel's, -0.5 to 0.5 (3 taps).
#if TAPS == 1
float tap_weight(int tap, float fraction) { return 1.0; }
#elif TAPS == 2
float tap_weight(int tap, float fraction) { return tap == 0 ? 1.0 - fraction : fraction; }
#else
float tap_weight(int tap, float fraction) {
  if (tap == 1) return 0.75 - fraction * fraction;
  float near = tap == 0 ? 0.5 - fraction : 0.5 + fraction;
  return 0.5 * near * near;
}
#endif

// 0 to 1; the sign bit is set where MARK is 1 and the map cannot decide.
float visibility(int layer, int r, vec3 position, vec3 normal, float cosine) {
  float texel_size = views[layer].direction.w;
  vec3 extent = views[layer].extent.xyz;
  vec3 at = map_coordinates(layer, position + normal * (normal_offset_texels * texel_size));
  float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
  float tangent = min(sine / cosine, STEEPEST_SLOPE);
  float texel_slope = texel_size * tangent / extent.z;  // depth over one texel of the receiver's plane
  float limit = at.z - depth_bias - position_bias / extent.z - angle_bias_texels * texel_slope - depth_rounding;

  ivec2 size = textureSize(depth_maps, 0).xy;
  vec2 place = at.xy * vec2(size) - 0.5;  // whole at texel centres
#if TAPS == 2
  vec2 first = floor(place), fraction = place - first;
#else
  vec2 middle = floor(place + 0.5), first = middle - float(TAPS / 2), fraction = place - middle;
#endif
#if RECEIVER_PLANE == 1
  vec2 across = vec2(dot(normal, views[layer].row_u.xyz) * extent.x, dot(normal, views[layer].row_v.xyz) * extent.y);
  vec2 slope = across * (tangent / max(sine, 1e-6)) * extent.xy / (vec2(size) * extent.z);  // depth per texel
#endif
#if TRIANGLE_IDS == 1
  uvec3 own = receiver_corners[r].xyz;
#endif
  float band = error_band_texels * texel_slope + 2.0 * depth_rounding;
  float lit = 0.0;
  bool any_lit = false, any_dark = false, within = false;
  for (int j = 0; j < TAPS; ++j)
    for (int i = 0; i < TAPS; ++i) {
      vec2 tap = first + vec2(i, j);
      ivec3 texel = ivec3(clamp(ivec2(tap), ivec2(0), size - 1), layer);
      float expected = limit;
#if RECEIVER_PLANE == 1
      expected += dot(slope, tap - place);
#endif
      float gap = stored_depth(texel) - min(expected, 1.0);  // nothing lies behind depth 1
      bool is_lit = gap >= 0.0, decided = abs(gap) > band;
#if TRIANGLE_IDS == 1
      if (is_neighbour(texel, own)) is_lit = decided = true;
#endif
      if (is_lit) lit += tap_weight(i, fraction.x) * tap_weight(j, fraction.y);
      any_lit = any_lit || is_lit;
      any_dark = any_dark || !is_lit;
      within = within || !decided;
    }
#if TAPS > 1
  lit = any_dark ? lit : 1.0;  // exactly
#endif
#if MARK == 1
  if (within || (any_lit && any_dark)) return uintBitsToFloat(floatBitsToUint(lit) | 0x80000000u);
#endif
  return lit;
}

void main() {
  int r = receiver_index();
#if REGIONS == 1
  classify_tile();
#endif
  if (r >= receiver_count) return;
  vec3 position = receivers[r].position.xyz;
  vec3 normal = receivers[r].normal.xyz;
#if REGIONS == 1
  uint tested = ((2u << uint(batch_directions - 1)) - 1u) & ~(tiles_behind | tiles_lit | tiles_shadowed);
  for (int d = 0; d < batch_directions; ++d) {
    float lit = float(tiles_lit >> uint(d) & 1u);
    weights[(first_row + d) * receiver_count + r] = lit * max(dot(normal, views[d].direction.xyz), 0.0);
  }
  for (; tested != 0u; tested &= tested - 1u) {
    int d = findLSB(tested);
#else
  for (int d = 0; d < batch_directions; ++d) {
#endif
    float cosine = dot(normal, views[d].direction.xyz);
    float weight = 0.0;
    if (cosine > 0.0) weight = cosine * visibility(d, r, position, normal, cosine);
    weights[(first_row + d) * receiver_count + r] = weight;
  }
}
