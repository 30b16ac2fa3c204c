// SPDX-License-Identifier: MIT
// Finds the shaders that tiles show: one invocation for each row of samples of a tile.
#include "shading_words.glsl"
#include "shading_tiles.glsl"

layout(local_size_x = 8, local_size_y = 16) in;

layout(binding = 3) uniform usampler2D surface_words;

void main() {
  ivec2 size = textureSize(surface_words, 0);
  int column = int(gl_GlobalInvocationID.x), j = int(gl_GlobalInvocationID.y);
  if (column >= grid_size.x || j >= size.y) return;
  uint mask = 0u;
  int end = min(tile_side * (column + 1), size.x);
  for (int i = tile_side * column; i < end; ++i) {
    int shader = shader_of(texelFetch(surface_words, ivec2(i, j), 0).w);
    if (shader >= 0) mask |= 1u << uint(shader);
  }
  if (mask != 0u) atomicOr(masks[j / tile_side * grid_size.x + column], mask);
}
