// SPDX-License-Identifier: MIT
// Puts the fragment at the head of its texel's list.
#include "bake_bundle_lists.glsl"

layout(std430, binding = 5) coherent buffer Heads {
  uint heads[];
};
layout(std430, binding = 6) writeonly buffer Entries {
  Entry entries[];
};
layout(std430, binding = 7) coherent buffer Counter {
  uint entry_count;
};
flat in int layer;
uniform uint capacity;  // room for entries; further ones are counted, not stored
uniform uint first_triangle;

void main() {
  uint entry = atomicAdd(entry_count, 1u);
  if (entry >= capacity) return;
  uint triangle = first_triangle + uint(gl_PrimitiveID);
  if (gl_FrontFacing) triangle |= FACES_LIGHT;
  uint next = atomicExchange(heads[texel_index(layer, ivec2(gl_FragCoord.xy))], entry);
  entries[entry] = Entry(gl_FragCoord.z, triangle, next);
}
