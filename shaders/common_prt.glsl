// SPDX-License-Identifier: MIT
// Computes exit radiance from a plain or a compressed asset under a light: the only shader that knows the format.
//
// A plain asset is a stack of coefficients. With t_i = min_i + s_i (max_i - min_i), where s_i is the stored value of
// plane i (0 to 1) and L_i the light's coefficient,
//
//   albedo sum_i L_i t_i  =  albedo sum_i L_i min_i  +  sum_i (albedo L_i (max_i - min_i)) s_i.
//
// A compressed asset follows [D3DX]'s equation of clustered PCA, where k is the cluster of the texel, M_k its mean,
// B_kj its basis vectors and w_pj = min_j + s_j (max_j - min_j) the texel's weights:
//
//   R_p = M_k . L' + sum_j w_pj (B_kj . L').
//
// Both are a constant plus a scale for each stored value, which cluster_weights (runtime/decode) computes once per
// light. A plane of one colour's transfer has zeros for the other colours. So the code below serves any number of
// bands, channels and components.
//
// Layer k of prt_planes holds planes 4k to 4k + 3 in its red, green, blue and alpha, so that 25 planes are 7 lookups.
// prt_light is the light, a small texture: for each incident-light sample, for each cluster, the constant (rgb), then
// three texels for each layer: the scales of its four planes for red, for green and for blue.
//
// PRT_FUNCTIONS: number of functions that light is a sum of, 1 to 8, in place of red, green and blue; 3 unless defined.
// What leaves is then a weight for each, of type PRT_LIGHT, before any albedo; constants take a texel for every four.
// PRT_SAMPLES: number of incident-light samples ([Chapter 2010], 4.3.3 to 4.3.6); 1 unless defined.
// PRT_PLACES: defined only if the samples of a point are not the first of prt_light; prt_places then says which.
// PRT_CLUSTERED: defined only if there are several clusters.
// PRT_STACKED: defined where several assets share the textures; the caller then says where those of one begin, for each
// pixel. Each has one cluster.
#ifndef PRT_SAMPLES
#define PRT_SAMPLES 1
#endif

#ifndef PRT_FUNCTIONS
#define PRT_FUNCTIONS 3
#endif

#if PRT_FUNCTIONS == 1
#define PRT_LIGHT float
#elif PRT_FUNCTIONS == 2
#define PRT_LIGHT vec2
#elif PRT_FUNCTIONS == 3
#define PRT_LIGHT vec3
#elif PRT_FUNCTIONS == 4
#define PRT_LIGHT vec4
#elif PRT_FUNCTIONS <= 6
#define PRT_LIGHT mat2x3
#else
#define PRT_LIGHT mat2x4
#endif

layout(binding = 0) uniform sampler2DArray prt_planes;
layout(binding = 2) uniform sampler2D prt_light;
#ifdef PRT_STACKED
int prt_layers, prt_first_layer, prt_first_light;
const int prt_clusters = 1;
#else
layout(location = 1) uniform int prt_layers;
layout(location = 2) uniform int prt_clusters;
const int prt_first_layer = 0, prt_first_light = 0;
#endif

const int prt_light_width = 1024;  // texels per row of prt_light

vec4 prt_light_at(int place) {
  return texelFetch(prt_light, ivec2(place % prt_light_width, place / prt_light_width), 0);
}

#ifdef PRT_PLACES
int prt_places[PRT_SAMPLES];
#endif

const int prt_constants = (PRT_FUNCTIONS + 3) / 4;  // texels of constants

// Reads the constants at a place of prt_light.
PRT_LIGHT prt_constant_at(int place) {
  vec4 first = prt_light_at(place);
#if PRT_FUNCTIONS == 1
  return first.x;
#elif PRT_FUNCTIONS == 2
  return first.xy;
#elif PRT_FUNCTIONS == 3
  return first.rgb;
#elif PRT_FUNCTIONS == 4
  return first;
#else
  vec4 second = prt_light_at(place + 1);
#if PRT_FUNCTIONS <= 6
  return mat2x3(first.xyz, vec3(first.w, second.xy));
#else
  return mat2x4(first, second);
#endif
#endif
}

// Multiplies the scales from a place of prt_light by the stored values of four planes.
PRT_LIGHT prt_scaled_at(int place, vec4 stored) {
#if PRT_FUNCTIONS == 1
  return dot(prt_light_at(place), stored);
#elif PRT_FUNCTIONS <= 4
  PRT_LIGHT light;
  for (int k = 0; k < PRT_FUNCTIONS; ++k) light[k] = dot(prt_light_at(place + k), stored);
  return light;
#else
  const int column = PRT_FUNCTIONS <= 6 ? 3 : 4;
  PRT_LIGHT light = PRT_LIGHT(0.0);
  for (int k = 0; k < PRT_FUNCTIONS; ++k) light[k / column][k % column] = dot(prt_light_at(place + k), stored);
  return light;
#endif
}

// Finds where the light of a sample and a cluster begins.
int prt_light_begin(int light_sample, int cluster) {
#ifdef PRT_PLACES
  light_sample = prt_places[light_sample];
#endif
  return prt_first_light + (light_sample * prt_clusters + cluster) * (prt_constants + PRT_FUNCTIONS * prt_layers);
}

// Mixes the constants of the samples; their `contributions` add up to 1.
PRT_LIGHT prt_constant(int cluster, float contributions[PRT_SAMPLES]) {
  PRT_LIGHT light = contributions[0] * prt_constant_at(prt_light_begin(0, cluster));
  for (int k = 1; k < PRT_SAMPLES; ++k) light += contributions[k] * prt_constant_at(prt_light_begin(k, cluster));
  return light;
}

// Computes what the four stored values of a layer add.
PRT_LIGHT prt_decoded(int cluster, int layer, vec4 stored, float contributions[PRT_SAMPLES]) {
  int first = prt_constants + PRT_FUNCTIONS * layer;
  PRT_LIGHT light = contributions[0] * prt_scaled_at(prt_light_begin(0, cluster) + first, stored);
  for (int k = 1; k < PRT_SAMPLES; ++k)
    light += contributions[k] * prt_scaled_at(prt_light_begin(k, cluster) + first, stored);
  return light;
}

// Computes radiance where all texels of a lookup belong to one cluster.
PRT_LIGHT prt_filtered(int cluster, vec2 uv, float contributions[PRT_SAMPLES]) {
  PRT_LIGHT radiance = prt_constant(cluster, contributions);
  for (int layer = 0; layer < prt_layers; ++layer)
    radiance += prt_decoded(cluster, layer, textureLod(prt_planes, vec3(uv, prt_first_layer + layer), 0.0), contributions);
  return radiance;
}

#ifdef PRT_CLUSTERED

layout(binding = 1) uniform usampler2D prt_cluster_ids;

PRT_LIGHT prt_texel_radiance(ivec2 texel, uint cluster, float contributions[PRT_SAMPLES]) {
  PRT_LIGHT radiance = prt_constant(int(cluster), contributions);
  for (int layer = 0; layer < prt_layers; ++layer)
    radiance += prt_decoded(int(cluster), layer, texelFetch(prt_planes, ivec3(texel, layer), 0), contributions);
  return radiance;
}

// Computes radiance from several clusters. Weights of two clusters belong to two bases and must not be mixed: if a
// lookup's four texels belong to several clusters, each is decoded by itself, and the results are blended. If they
// belong to one, which is almost everywhere, decoding and blending commute, and the texture unit blends.
PRT_LIGHT prt_exit_radiance(vec2 uv, float contributions[PRT_SAMPLES]) {
  ivec2 size = textureSize(prt_cluster_ids, 0);
  vec2 place = uv * vec2(size) - 0.5;
  ivec2 corner = ivec2(floor(place));
  // Gathers at the corner that the four texels share, so that no rounding can choose other texels.
  uvec4 ids = textureGather(prt_cluster_ids, (vec2(corner) + 1.0) / vec2(size));
  if (ids.x == ids.y && ids.y == ids.z && ids.z == ids.w) return prt_filtered(int(ids.x), uv, contributions);
  vec2 share = place - vec2(corner);
  ivec2 low = clamp(corner, ivec2(0), size - 1), high = clamp(corner + 1, ivec2(0), size - 1);
  // Order of textureGather: upper left, upper right, lower right, lower left, where the first row is the lower one.
  // Weighs by products, since mix takes no matrices.
  PRT_LIGHT upper = (1.0 - share.x) * prt_texel_radiance(ivec2(low.x, high.y), ids.x, contributions) +
                    share.x * prt_texel_radiance(high, ids.y, contributions);
  PRT_LIGHT lower = (1.0 - share.x) * prt_texel_radiance(low, ids.w, contributions) +
                    share.x * prt_texel_radiance(ivec2(high.x, low.y), ids.z, contributions);
  return (1.0 - share.y) * lower + share.y * upper;
}

#else

// Computes linear RGB (or weights of functions), which may be below 0 where truncated harmonics ring.
PRT_LIGHT prt_exit_radiance(vec2 uv, float contributions[PRT_SAMPLES]) {
  return prt_filtered(0, uv, contributions);
}

#endif
