// SPDX-License-Identifier: MIT
// Conservative regions: a tile of receivers that the coarse maps of bake_regions.comp show to be wholly lit or wholly
// shadowed from a direction needs no test of its receivers. Margins cover whatever a test may add, so that no result
// changes.
struct Tile {
  vec4 sphere;  // centre and radius, object space
  vec4 cone;    // cone of the normals: axis, sine of the half-angle
};

layout(std430, binding = 7) readonly buffer TileBounds {
  Tile tile_bounds[];
};
layout(std430, binding = 8) buffer TileCounts {
  uint tile_counts[3];  // pairs of a receiver and a direction: behind, lit, shadowed
};
layout(binding = 3) uniform sampler2DArray region_maps;

// Bit d of one of these: the tile's class from direction d of the batch. In none of them: its receivers must be tested.
shared uint tiles_behind, tiles_lit, tiles_shadowed;

const uint CLASS_TESTED = 0u, CLASS_BEHIND = 1u, CLASS_LIT = 2u, CLASS_SHADOWED = 3u;

uint tile_class(Tile tile, int layer) {
  const float tap_reach = 2.2;  // largest distance, in texels, between a receiver and a centre that it is compared at
  const int most_cells = 6;     // largest number of cells a side
  float texel_size = views[layer].direction.w;
  vec3 extent = views[layer].extent.xyz;
  if (dot(tile.cone.xyz, views[layer].direction.xyz) < -tile.cone.w) return CLASS_BEHIND;

  float reach = tile.sphere.w * 1.0001 + normal_offset_texels * texel_size;
  vec3 at = map_coordinates(layer, tile.sphere.xyz);
  vec2 size = vec2(textureSize(depth_maps, 0).xy), reach_texels = reach / extent.xy * size + tap_reach;
  ivec2 last_cell = textureSize(region_maps, 0).xy - 1;
  ivec2 low = clamp(ivec2(floor((at.xy * size - reach_texels) / float(CELL))), ivec2(0), last_cell);
  ivec2 high = clamp(ivec2(floor((at.xy * size + reach_texels) / float(CELL))), ivec2(0), last_cell);
  if (any(greaterThanEqual(high - low, ivec2(most_cells)))) return CLASS_TESTED;
  float least = 1.0, greatest = 0.0;
  for (int j = low.y; j <= high.y; ++j)
    for (int i = low.x; i <= high.x; ++i) {
      vec2 depths = texelFetch(region_maps, ivec3(i, j, layer), 0).rg;
      least = min(least, depths.x);
      greatest = max(greatest, depths.y);
    }

  // Steepest tangent of the normals, from the cone.
  float cosine = dot(tile.cone.xyz, views[layer].direction.xyz), sine = sqrt(max(1.0 - cosine * cosine, 0.0));
  float least_cosine = cosine * sqrt(max(1.0 - tile.cone.w * tile.cone.w, 0.0)) - sine * tile.cone.w - 1e-4;
  float tangent = STEEPEST_SLOPE;
  if (least_cosine > 0.0) tangent = min(tangent, sqrt(1.0 - least_cosine * least_cosine) / least_cosine);
  float slack = depth_bias + position_bias / extent.z + (angle_bias_texels + error_band_texels + tap_reach) * tangent * texel_size / extent.z + 4.0 * depth_rounding + 1e-6;
  if (at.z + reach / extent.z + slack < least) return CLASS_LIT;
#if TRIANGLE_IDS == 0
  if (min(at.z - reach / extent.z - slack, 1.0) > greatest) return CLASS_SHADOWED;  // nothing lies behind depth 1
#endif
  return CLASS_TESTED;
}

// Classifies the tile; all invocations of the workgroup call it, and see the masks afterwards.
void classify_tile() {
  uint lane = gl_LocalInvocationID.x;
  if (lane == 0u) tiles_behind = tiles_lit = tiles_shadowed = 0u;
  barrier();
  uint tile = tiles[gl_WorkGroupID.x];
  if (int(lane) < batch_directions) {
    uint kind = tile_class(tile_bounds[tile], int(lane));
    if (kind == CLASS_BEHIND) atomicOr(tiles_behind, 1u << lane);
    if (kind == CLASS_LIT) atomicOr(tiles_lit, 1u << lane);
    if (kind == CLASS_SHADOWED) atomicOr(tiles_shadowed, 1u << lane);
  }
  barrier();
  if (lane == 0u) {
    uint own = min(gl_WorkGroupSize.x, uint(receiver_count) - tile * gl_WorkGroupSize.x);
    atomicAdd(tile_counts[0], own * uint(bitCount(tiles_behind)));
    atomicAdd(tile_counts[1], own * uint(bitCount(tiles_lit)));
    atomicAdd(tile_counts[2], own * uint(bitCount(tiles_shadowed)));
  }
}
