// Every receiver against the depth maps of a batch of directions: clamped cosine times visibility.
//   PCF  1: visibility is the bilinear mean of 2 x 2 depth comparisons; 0: one comparison
#include "bake_views.glsl"
#include "bake_receivers.glsl"

layout(std430, binding = 2) writeonly buffer Weights {
  float weights[];  // direction after direction
};

layout(binding = 0) uniform sampler2DArray depth_maps;
uniform int batch_directions;
uniform int first_row;               // of the batch among the block's weights
uniform float depth_bias;            // in map depths, 0 to 1
uniform float normal_offset_texels;  // of the depth map

float visibility(int layer, vec3 position, vec3 normal) {
  vec3 at = map_coordinates(layer, position + normal * (normal_offset_texels * views[layer].direction.w));
  float limit = at.z - depth_bias;
  ivec2 size = textureSize(depth_maps, 0).xy;
#if PCF == 0
  ivec2 texel = clamp(ivec2(floor(at.xy * vec2(size))), ivec2(0), size - 1);
  return texelFetch(depth_maps, ivec3(texel, layer), 0).r >= limit ? 1.0 : 0.0;
#else
  vec2 place = at.xy * vec2(size) - 0.5;
  vec2 corner = floor(place);
  vec2 weight = place - corner;
  ivec2 low = clamp(ivec2(corner), ivec2(0), size - 1), high = min(low + 1, size - 1);
  vec4 depths =
      vec4(texelFetch(depth_maps, ivec3(low, layer), 0).r, texelFetch(depth_maps, ivec3(high.x, low.y, layer), 0).r,
           texelFetch(depth_maps, ivec3(low.x, high.y, layer), 0).r, texelFetch(depth_maps, ivec3(high, layer), 0).r);
  vec4 lit = vec4(greaterThanEqual(depths, vec4(limit)));
  return mix(mix(lit.x, lit.y, weight.x), mix(lit.z, lit.w, weight.x), weight.y);
#endif
}

void main() {
  int r = receiver_index();
  if (r >= receiver_count) return;
  vec3 position = receivers[r].position.xyz;
  vec3 normal = receivers[r].normal.xyz;
  for (int d = 0; d < batch_directions; ++d) {
    float weight = dot(normal, views[d].direction.xyz);
    if (weight > 0.0) weight *= visibility(d, position, normal);
    weights[(first_row + d) * receiver_count + r] = max(weight, 0.0);
  }
}
