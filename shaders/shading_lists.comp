// SPDX-License-Identifier: MIT
// Puts each tile into the list of its set of shaders, or into the lists of all its shaders.
// SHADING_SHADERS: number of shaders. SHADING_ALL_SETS: defined if each set has a list, by its mask less 1; else each
// shader has one, and the last is of tiles that show several.
#include "shading_tiles.glsl"

layout(local_size_x = 64) in;

layout(location = 1) uniform bool by_sets;

void append(uint list, uint tile, uint tiles) {
  uint place = atomicAdd(commands[list].tiles, 1u);
  listed[list * tiles + place] = tile;
}

uint list_of(uint mask) {
#ifdef SHADING_ALL_SETS
  return mask - 1u;
#else
  return bitCount(mask) == 1 ? uint(findLSB(mask)) : uint(SHADING_SHADERS);
#endif
}

void main() {
  uint tile = gl_GlobalInvocationID.x, tiles = uint(grid_size.x * grid_size.y);
  if (tile >= tiles) return;
  uint mask = masks[tile];
  if (mask == 0u) return;
  if (by_sets) {
    append(list_of(mask), tile, tiles);
  } else {
    for (uint shader = 0u; shader < uint(SHADING_SHADERS); ++shader)
      if ((mask >> shader & 1u) != 0u) append(list_of(1u << shader), tile, tiles);
  }
}
