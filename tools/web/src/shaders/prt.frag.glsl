// SPDX-License-Identifier: MIT
// Computes exit radiance from planes and light, as shaders/common_prt.glsl of the runtime does.
#include <common>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>

varying vec2 kiln_uv;
uniform float opacity;

#ifdef KILN_ALBEDO
uniform sampler2D kiln_albedo;
#endif
#ifdef KILN_OPACITY
uniform sampler2D kiln_opacity;
#endif

#ifdef KILN_VERTICES
varying vec3 kiln_radiance;
vec3 exit_radiance(vec2 uv) {
  return kiln_radiance;
}
#else
uniform highp sampler2DArray kiln_planes;
uniform highp sampler2D kiln_light;
uniform int kiln_layers;

// The light's texture: for each cluster the constant (rgb), then for each layer the scales of its four planes for red,
// for green and for blue.
vec4 light_at(int place) {
  return texelFetch(kiln_light, ivec2(place % KILN_LIGHT_WIDTH, place / KILN_LIGHT_WIDTH), 0);
}

vec3 decoded(int begin, int layer, vec4 stored) {
  int at = begin + 1 + 3 * layer;
  return vec3(dot(light_at(at), stored), dot(light_at(at + 1), stored), dot(light_at(at + 2), stored));
}

// Looks up four stored values, bilinearly. Texture units may filter bytes in 8 bits, which is too few for pairs of them:
// those are blended here.
vec4 stored_at(vec2 uv, int layer) {
#ifdef KILN_EXACT
  ivec2 size = textureSize(kiln_planes, 0).xy;
  vec2 place = uv * vec2(size) - 0.5, corner = floor(place), share = place - corner;
  ivec2 low = clamp(ivec2(corner), ivec2(0), size - 1), high = clamp(ivec2(corner) + 1, ivec2(0), size - 1);
  return mix(mix(texelFetch(kiln_planes, ivec3(low, layer), 0), texelFetch(kiln_planes, ivec3(high.x, low.y, layer), 0), share.x),
             mix(texelFetch(kiln_planes, ivec3(low.x, high.y, layer), 0), texelFetch(kiln_planes, ivec3(high, layer), 0), share.x),
             share.y);
#else
  return textureLod(kiln_planes, vec3(uv, float(layer)), 0.0);
#endif
}

// Computes radiance where all texels of a lookup belong to one cluster.
vec3 filtered(int cluster, vec2 uv) {
  int begin = cluster * (1 + 3 * kiln_layers);
  vec3 radiance = light_at(begin).rgb;
  for (int layer = 0; layer < kiln_layers; ++layer)
    radiance += decoded(begin, layer, stored_at(uv, layer));
  return radiance;
}

#ifdef KILN_CLUSTERS
uniform highp usampler2D kiln_clusters;

vec3 of_texel(ivec2 texel, int cluster) {
  int begin = cluster * (1 + 3 * kiln_layers);
  vec3 radiance = light_at(begin).rgb;
  for (int layer = 0; layer < kiln_layers; ++layer)
    radiance += decoded(begin, layer, texelFetch(kiln_planes, ivec3(texel, layer), 0));
  return radiance;
}

// Weights of two clusters must not be mixed: where the four texels of a lookup are of several, each is decoded by
// itself and the results are blended.
vec3 exit_radiance(vec2 uv) {
  ivec2 size = textureSize(kiln_clusters, 0);
  vec2 place = uv * vec2(size) - 0.5;
  ivec2 corner = ivec2(floor(place));
  ivec2 low = clamp(corner, ivec2(0), size - 1), high = clamp(corner + 1, ivec2(0), size - 1);
  int a = int(texelFetch(kiln_clusters, low, 0).r), b = int(texelFetch(kiln_clusters, ivec2(high.x, low.y), 0).r);
  int c = int(texelFetch(kiln_clusters, ivec2(low.x, high.y), 0).r), d = int(texelFetch(kiln_clusters, high, 0).r);
  if (a == b && a == c && a == d) return filtered(a, uv);
  vec2 share = place - vec2(corner);
  return mix(mix(of_texel(low, a), of_texel(ivec2(high.x, low.y), b), share.x),
             mix(of_texel(ivec2(low.x, high.y), c), of_texel(high, d), share.x), share.y);
}
#else
vec3 exit_radiance(vec2 uv) {
  return filtered(0, uv);
}
#endif
#endif

#ifdef KILN_SIGNED
uniform float kiln_gain;
#endif

void main() {
  #include <clipping_planes_fragment>
  #include <logdepthbuf_fragment>
#ifdef KILN_OPACITY
  if (textureLod(kiln_opacity, kiln_uv, 0.0).r < 0.5) discard;
#endif
  vec3 radiance = exit_radiance(kiln_uv);
#ifdef KILN_SIGNED
  // Shows a number: blue below 0, grey at 0, red above.
  float value = kiln_gain * dot(radiance, vec3(1.0 / 3.0));
  vec3 nothing = vec3(0.67), above = vec3(0.54, 0.01, 0.007), below = vec3(0.01, 0.06, 0.51);
  gl_FragColor = vec4(mix(nothing, value > 0.0 ? above : below, min(abs(value), 1.0)), 1.0);
#else
#ifdef KILN_ALBEDO
  radiance *= texture2D(kiln_albedo, kiln_uv).rgb;
#endif
  // Truncated harmonics ring a little below 0.
  gl_FragColor = vec4(max(radiance, 0.0), opacity);
  #include <tonemapping_fragment>
#endif
  #include <colorspace_fragment>
  #include <fog_fragment>
}
