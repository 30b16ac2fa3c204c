// SPDX-License-Identifier: MIT
// Makes a coarse map of each depth map: the least and the greatest depth of every square of CELL x CELL texels.
//   CELL      texels a side
//   MIDPOINT  as in bake_weigh.comp
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2DArray depth_maps;
#if MIDPOINT == 1
layout(binding = 1) uniform sampler2DArray back_depth_maps;
#endif
layout(rg32f, binding = 0) writeonly uniform image2DArray region_maps;

void main() {
  ivec3 cell = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(cell.xy, imageSize(region_maps).xy))) return;
  ivec2 first = cell.xy * CELL, last = min(first + CELL, textureSize(depth_maps, 0).xy);
  float least = 1.0, greatest = 0.0;
  for (int j = first.y; j < last.y; ++j)
    for (int i = first.x; i < last.x; ++i) {
      ivec3 texel = ivec3(i, j, cell.z);
      float depth = texelFetch(depth_maps, texel, 0).r;
#if MIDPOINT == 1
      depth = 0.5 * (depth + texelFetch(back_depth_maps, texel, 0).r);
#endif
      least = min(least, depth);
      greatest = max(greatest, depth);
    }
  imageStore(region_maps, cell, vec4(least, greatest, 0.0, 0.0));
}
