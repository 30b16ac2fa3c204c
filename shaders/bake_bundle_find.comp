// SPDX-License-Identifier: MIT
// Finds what every receiver sees along a batch of directions: the nearest fragment in front of it in its texel's list.
//   STEEPEST_SLOPE  largest tangent of the angle between normal and direction that a slope or bias follows
//   RECEIVER_PLANE  1: fragments are compared with the receiver's tangent plane at the texel's centre
#include "bake_views.glsl"
#include "bake_receivers.glsl"
#include "bake_bundle_lists.glsl"

layout(std430, binding = 2) writeonly buffer Hits {
  uvec4 hits[];  // direction after direction: triangle, and the cosine times the weights of its corners, as floats
};
layout(std430, binding = 5) readonly buffer Heads {
  uint heads[];
};
layout(std430, binding = 6) readonly buffer Entries {
  Entry entries[];
};
layout(std430, binding = 8) readonly buffer Positions {
  float positions[];  // three per vertex
};
layout(std430, binding = 9) readonly buffer Corners {
  uint corners[];  // three per triangle
};
uniform int batch_directions;
uniform int first_row;               // row of the batch's first direction among the block's hits
uniform float depth_bias;            // in map depths, 0 to 1
uniform float position_bias;         // in object units
uniform float angle_bias_texels;     // in texels of the map
uniform float normal_offset_texels;  // in texels of the map
uniform float depth_rounding;        // in map depths

vec3 corner_position(uint triangle, int corner) {
  uint vertex = corners[3u * triangle + uint(corner)];
  return vec3(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]);
}

// Finds the nearest fragment in front of the receiver; END_OF_LIST if there is none. Depth decides and, for equal
// depths, the triangle's number, so that the order of the list does not matter.
uint nearest_before(int layer, vec3 position, vec3 normal, float cosine) {
  float texel_size = views[layer].direction.w;
  vec3 extent = views[layer].extent.xyz;
  vec3 at = map_coordinates(layer, position + normal * (normal_offset_texels * texel_size));
  float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
  float tangent = min(sine / cosine, STEEPEST_SLOPE);
  float texel_slope = texel_size * tangent / extent.z;  // depth over one texel along the receiver's plane
  float limit = at.z - depth_bias - position_bias / extent.z - angle_bias_texels * texel_slope - depth_rounding;
  vec2 place = at.xy * float(size) - 0.5;  // a whole number at texel centres
  vec2 tap = floor(place + 0.5);
#if RECEIVER_PLANE == 1
  vec2 across = vec2(dot(normal, views[layer].row_u.xyz) * extent.x, dot(normal, views[layer].row_v.xyz) * extent.y);
  vec2 slope = across * (tangent / max(sine, 1e-6)) * extent.xy / (float(size) * extent.z);  // depth per texel
  limit += dot(slope, tap - place);
#endif
  if (any(lessThan(tap, vec2(0.0))) || any(greaterThanEqual(tap, vec2(size)))) return END_OF_LIST;
  uint found = END_OF_LIST;
  float depth = -1.0;
  for (uint e = heads[texel_index(layer, ivec2(tap))]; e != END_OF_LIST; e = entries[e].next) {
    float other = entries[e].depth;
    uint triangle = entries[e].triangle;
    if (other >= limit || other < depth) continue;
    if (other == depth && triangle < found) continue;
    depth = other;
    found = triangle;
  }
  return found;
}

void main() {
  int r = receiver_index();
  if (r >= receiver_count) return;
  vec3 position = receivers[r].position.xyz;
  vec3 normal = receivers[r].normal.xyz;
  for (int d = 0; d < batch_directions; ++d) {
    vec3 direction = views[d].direction.xyz;
    float cosine = dot(normal, direction);
    uint triangle = END_OF_LIST;
    if (cosine > 0.0) triangle = nearest_before(d, position, normal, cosine);
    vec3 weights = vec3(0.0);
    if ((triangle & FACES_LIGHT) == 0u) {
      // The point where the ray meets the triangle's plane or, if that is outside by a fraction of a texel, a point
      // inside nearby.
      vec3 a = corner_position(triangle, 0), ab = corner_position(triangle, 1) - a, ac = corner_position(triangle, 2) - a;
      vec3 across = cross(ab, ac);
      float along = dot(across, direction);
      vec3 place = position - a;
      if (along != 0.0) place -= direction * (dot(across, place) / along);
      float area = max(dot(across, across), 1e-37);
      float u = max(dot(cross(place, ac), across) / area, 0.0), v = max(dot(cross(ab, place), across) / area, 0.0);
      float beyond = max(u + v, 1.0);
      u /= beyond;
      v /= beyond;
      weights = cosine * vec3(1.0 - u - v, u, v);
    } else {
      triangle = END_OF_LIST;
    }
    hits[(first_row + d) * receiver_count + r] = uvec4(triangle, floatBitsToUint(weights));
  }
}
