// SPDX-License-Identifier: MIT
// Covers the tiles of a list, each by one point as large as a tile: triangles would shade the blocks of samples along
// their common side twice. The viewport has whole tiles.
#include "shading_tiles.glsl"

layout(location = 1) uniform int drawn_list;

void main() {
  uint tile = listed[drawn_list * grid_size.x * grid_size.y + gl_InstanceID];
  ivec2 place = ivec2(int(tile) % grid_size.x, int(tile) / grid_size.x);
  gl_PointSize = float(tile_side);
  gl_Position = vec4((2.0 * vec2(place) + 1.0) / vec2(grid_size) - 1.0, 0.0, 1.0);
}
