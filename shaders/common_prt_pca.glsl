// Exit radiance from a compressed asset: the D3DX equation of clustered PCA,
//
//   R_p = M_k . L' + sum_j w_pj (B_kj . L'),
//
// k the cluster of the texel, M_k its mean, B_kj its basis vectors, w_pj = min_j + s_j (max_j - min_j) the texel's weights,
// stored as s_j. The dot products, with the albedo and the ranges in them, are cluster_weights' (stages/relight/relight.h),
// computed once per light: per cluster a constant and for every layer three scales, as common_prt.glsl has them. With one
// cluster this is that shader.
//
// Weights of two clusters are of two bases and must not be mixed: where a lookup's four texels are of several clusters each
// is decoded by itself, and what they decode to is blended. Where they are of one, which is almost everywhere, decoding
// and blending commute, and the texture unit does it.
layout(binding = 0) uniform sampler2DArray prt_planes;
layout(binding = 1) uniform usampler2D prt_cluster_ids;
layout(location = 1) uniform int prt_layers;

layout(std430, binding = 0) readonly buffer PrtWeights {
  vec4 prt_clusters[];  // per cluster the constant (rgb), then three per layer: what its planes add to red, green and blue
};

vec3 prt_decoded(uint cluster, int layer, vec4 stored) {
  uint at = cluster * uint(1 + 3 * prt_layers) + uint(1 + 3 * layer);
  return vec3(dot(prt_clusters[at], stored), dot(prt_clusters[at + 1u], stored), dot(prt_clusters[at + 2u], stored));
}

vec3 prt_constant_of(uint cluster) {
  return prt_clusters[cluster * uint(1 + 3 * prt_layers)].rgb;
}

vec3 prt_texel_radiance(ivec2 texel, uint cluster) {
  vec3 radiance = prt_constant_of(cluster);
  for (int layer = 0; layer < prt_layers; ++layer)
    radiance += prt_decoded(cluster, layer, texelFetch(prt_planes, ivec3(texel, layer), 0));
  return radiance;
}

// Linear RGB; may be below 0 where truncated harmonics ring.
vec3 prt_exit_radiance(vec2 uv) {
  ivec2 size = textureSize(prt_cluster_ids, 0);
  vec2 place = uv * vec2(size) - 0.5;
  ivec2 corner = ivec2(floor(place));
  // At the corner that the four texels share, so that no rounding can choose other ones.
  uvec4 ids = textureGather(prt_cluster_ids, (vec2(corner) + 1.0) / vec2(size));
  if (ids.x == ids.y && ids.y == ids.z && ids.z == ids.w) {
    vec3 radiance = prt_constant_of(ids.x);
    for (int layer = 0; layer < prt_layers; ++layer)
      radiance += prt_decoded(ids.x, layer, textureLod(prt_planes, vec3(uv, layer), 0.0));
    return radiance;
  }
  vec2 share = place - vec2(corner);
  ivec2 low = clamp(corner, ivec2(0), size - 1), high = clamp(corner + 1, ivec2(0), size - 1);
  // textureGather's order: upper left, upper right, lower right, lower left, the lower being the first row.
  vec3 upper = mix(prt_texel_radiance(ivec2(low.x, high.y), ids.x), prt_texel_radiance(high, ids.y), share.x);
  vec3 lower = mix(prt_texel_radiance(low, ids.w), prt_texel_radiance(ivec2(high.x, low.y), ids.z), share.x);
  return mix(lower, upper, share.y);
}
