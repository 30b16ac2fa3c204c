// SPDX-License-Identifier: MIT
// Covers the tiles of a list with two triangles each.
#include "shading_tiles.glsl"

layout(location = 1) uniform int drawn_list;
layout(location = 2) uniform ivec2 sample_count;  // of the picture, across and up

void main() {
  uint tile = listed[drawn_list * grid_size.x * grid_size.y + gl_InstanceID];
  ivec2 place = ivec2(int(tile) % grid_size.x, int(tile) / grid_size.x);
  const ivec2 corners[6] = ivec2[6](ivec2(0, 0), ivec2(1, 0), ivec2(1, 1), ivec2(0, 0), ivec2(1, 1), ivec2(0, 1));
  ivec2 corner = min(tile_side * (place + corners[gl_VertexID]), sample_count);
  gl_Position = vec4(2.0 * vec2(corner) / vec2(sample_count) - 1.0, 0.0, 1.0);
}
