// SPDX-License-Identifier: MIT
// Tiles of a picture, and the lists of those that a pass shades: one list for each set of shaders.
const int tile_side = 16;  // samples

struct DrawCommand {
  uint vertices, tiles, first_vertex, first_instance;
};

layout(location = 0) uniform ivec2 grid_size;  // tiles across and up
layout(std430, binding = 1) buffer Masks {
  uint masks[];  // for each tile, a bit for each shader that it shows
};
layout(std430, binding = 2) buffer Commands {
  DrawCommand commands[];  // of each list
};
layout(std430, binding = 3) buffer Lists {
  uint listed[];  // tiles of the first list, then of the next; each has room for all
};
