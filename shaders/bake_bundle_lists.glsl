// SPDX-License-Identifier: MIT
// Lists of fragments for a batch of directions, one per texel of each direction's map (stages/bake/egl/bundle_lists.h).
const uint END_OF_LIST = 0xffffffffu;
const uint FACES_LIGHT = 0x80000000u;  // set if a triangle turns its front to the light, its back to receivers

struct Entry {
  float depth;  // 0 is nearest to the light
  uint triangle;
  uint next;
};
uniform int size;  // texels a side of a map

int texel_index(int layer, ivec2 texel) { return (layer * size + texel.y) * size + texel.x; }
