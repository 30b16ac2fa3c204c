// SPDX-License-Identifier: MIT
// Sums the light that receivers get from the surface points that they see, over a block of directions: float32 sums
// that stay in registers, and are then added to the totals.
//   CHUNK   components of a chunk, a multiple of 4
#include "bake_receivers.glsl"
#include "bake_totals.glsl"

layout(std430, binding = 2) readonly buffer Hits {
  uvec4 hits[];  // as in shaders/bake_bundle_find.comp
};
layout(std430, binding = 9) readonly buffer Points {
  uint points[];  // for each triangle, the points of its three corners
};
layout(std430, binding = 10) readonly buffer Radiance {
  vec4 radiance[];  // point after point, the components of the chunk
};
uniform int block_directions;
uniform int first_coefficient;

void main() {
  int r = receiver_index();
  if (r >= receiver_count) return;
  vec4 sums[CHUNK / 4];
  for (int i = 0; i < CHUNK / 4; ++i) sums[i] = vec4(0.0);
  for (int d = 0; d < block_directions; ++d) {
    uvec4 hit = hits[d * receiver_count + r];
    if (hit.x == 0xffffffffu) continue;
    vec3 weights = uintBitsToFloat(hit.yzw);
    uvec3 first = uvec3(points[3u * hit.x], points[3u * hit.x + 1u], points[3u * hit.x + 2u]) * uint(CHUNK / 4);
    for (int i = 0; i < CHUNK / 4; ++i)
      sums[i] += weights.x * radiance[first.x + uint(i)] + weights.y * radiance[first.y + uint(i)] +
                 weights.z * radiance[first.z + uint(i)];
  }
  for (int i = 0; i < CHUNK; ++i) add_to_total((first_coefficient + i) * receiver_count + r, sums[i / 4][i % 4]);
}
