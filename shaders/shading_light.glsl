// SPDX-License-Identifier: MIT
// The light: the work that all shaders share. Lights with a direction have shadow maps [Williams 1978], filtered by
// comparison [Reeves 1987]; the rest arrives by precomputed transfer where the node's asset has planes, else as
// irradiance in nine harmonics [Ramamoorthi 2001]. Nodes with planes may take all diffuse light by these; maps then
// shadow their highlights alone, so that nothing is darkened twice.
// SHADING_PRT: defined if a node has planes.
#ifdef SHADING_PRT
#define PRT_STACKED
#ifdef SHADING_POINTS
#define PRT_PLACES
#ifdef SHADING_AT_VERTICES
#define PRT_SAMPLES 3
#else
#define PRT_SAMPLES SHADING_POINTS
#endif
#endif
#include "common_prt.glsl"
#ifdef SHADING_POINTS
#include "shading_points.glsl"
#endif
#endif

struct DirectLight {
  vec4 place;     // xyz: a ball's centre, or the unit vector towards a distant light; w: a ball's radius, 0 if distant
  vec4 radiance;  // rgb; a: width of a texel of its shadow map, at a depth of 1 for a ball
};

const int most_direct_lights = 4;

layout(std140, binding = 1) uniform Lights {
  ivec4 light_count;
  vec4 irradiance[9];  // rgb, divided by pi
  vec4 background;     // rgb, where the reflection map shows nothing
  DirectLight direct_lights[most_direct_lights];
  mat4 shadow_from_scene[most_direct_lights];
};

layout(binding = 6) uniform sampler2DArrayShadow shadow_maps;
layout(binding = 7) uniform sampler2D reflection_map;

// Evaluates the first three bands of the basis of stages/core/sh/basis.h.
vec3 irradiance_at(vec3 n) {
  vec3 sum = 0.282095 * irradiance[0].rgb;
  sum += 0.488603 * (n.y * irradiance[1].rgb + n.z * irradiance[2].rgb + n.x * irradiance[3].rgb);
  sum += 1.092548 * (n.x * n.y * irradiance[4].rgb + n.y * n.z * irradiance[5].rgb + n.x * n.z * irradiance[7].rgb);
  sum += 0.315392 * (3.0 * n.z * n.z - 1.0) * irradiance[6].rgb;
  sum += 0.546274 * (n.x * n.x - n.y * n.y) * irradiance[8].rgb;
  return sum;
}

// Returns the part of a light that arrives: nine comparisons, each filtered by the texture unit. The place is moved
// along the normal by two texels, so that a surface does not shadow itself.
float visibility(int light, Surface surface) {
  mat4 to_map = shadow_from_scene[light];
  float depth = (to_map * vec4(surface.position, 1.0)).w;
  if (depth <= 0.0) return 1.0;  // behind the light's map
  vec3 moved = surface.position + 2.0 * direct_lights[light].radiance.a * depth * surface.mesh_normal;
  vec4 place = to_map * vec4(moved, 1.0);
  place.xyz /= place.w;
  place.z = min(place.z, 1.0);  // behind all that casts shadows
  vec2 texel = 1.0 / vec2(textureSize(shadow_maps, 0).xy);
  float sum = 0.0;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i)
      sum += texture(shadow_maps, vec4(place.xy + vec2(i, j) * texel, light, place.z));
  return sum / 9.0;
}

vec3 rest_of_light(Surface surface, vec3 normal) {
#ifdef SHADING_PRT
  ivec4 planes = ivec4(node_vector(kiln_node, 7));
  prt_layers = planes.y;
  if (prt_layers > 0) {
    prt_first_layer = planes.x;
    prt_first_light = planes.z;
    vec4 place = node_vector(kiln_node, 8);
    float contributions[PRT_SAMPLES];
#ifdef SHADING_POINTS
    find_contributions(surface, contributions);
#else
    contributions[0] = 1.0;
#endif
    return prt_exit_radiance(clamp(place.xy * surface.uv, place.zw, place.xy - place.zw), contributions);
  }
#endif
  return irradiance_at(normal);
}

Light light_at(Surface surface, Appearance appearance) {
  Light light;
  light.diffuse = rest_of_light(surface, appearance.normal);
  light.specular = vec3(0.0);
  light.reflection = vec3(0.0);
  light.visibility = 1.0;
  bool by_transfer = node_vector(kiln_node, 7).w > 0.0;
  for (int k = 0; k < light_count.x; ++k) {
    if (by_transfer && k > 0 && appearance.shininess <= 0.0) continue;
    vec3 towards = direct_lights[k].place.xyz, radiance = direct_lights[k].radiance.rgb;
    float radius = direct_lights[k].place.w;
    if (radius > 0.0) {
      towards -= surface.position;
      float squared = dot(towards, towards);
      radiance *= min(1.0, radius * radius / squared);
      towards *= inversesqrt(max(squared, 1e-30));
    }
    float arriving = visibility(k, surface);
    if (k == 0) light.visibility = arriving;
    float cosine = dot(appearance.normal, towards);
    if (cosine <= 0.0) continue;
    if (!by_transfer) light.diffuse += cosine * arriving * radiance;
    if (appearance.shininess > 0.0)
      light.specular += pow(max(0.0, dot(reflect(-towards, appearance.normal), surface.to_eye)), appearance.shininess) *
                        arriving * radiance;
  }
  if (appearance.mirror > 0.0) {
    vec4 place = picture_from_scene * vec4(surface.position, 1.0);
    vec4 seen = textureLod(reflection_map, 0.5 * place.xy / place.w + 0.5, appearance.blur);
    light.reflection = seen.rgb + (1.0 - seen.a) * background.rgb;
  }
  return light;
}
