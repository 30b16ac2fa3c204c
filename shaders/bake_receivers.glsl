// SPDX-License-Identifier: MIT
// Receivers (texels of the atlas, or any points) and tiles of them; a workgroup handles one tile.
struct Receiver {
  vec4 position;  // xyz, object space
  vec4 normal;    // xyz, unit
};

layout(local_size_x = 64) in;

layout(std430, binding = 1) readonly buffer ReceiverList {
  Receiver receivers[];
};
layout(std430, binding = 4) readonly buffer TileList {
  uint tiles[];
};
uniform int receiver_count;

int receiver_index() { return int(tiles[gl_WorkGroupID.x] * gl_WorkGroupSize.x + gl_LocalInvocationID.x); }
