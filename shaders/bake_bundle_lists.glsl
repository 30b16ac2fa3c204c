// SPDX-License-Identifier: MIT
// Fragments of a batch of directions in lists, one per texel of each direction's map (stages/bake/egl/bundle_lists.h).
const uint END_OF_LIST = 0xffffffffu;
const uint FACES_LIGHT = 0x80000000u;  // a triangle with that bit turns its front to the light, its back to receivers

struct Entry {
  float depth;  // 0 nearest to the light
  uint triangle;
  uint next;
};
uniform int size;  // of a map, texels a side

int texel_index(int layer, ivec2 texel) { return (layer * size + texel.y) * size + texel.x; }
