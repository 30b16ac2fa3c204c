// SPDX-License-Identifier: MIT
// Shades by [Phong 1975], without shadows. Balls light by the inverse square of their distance; light without a
// direction arrives as irradiance in nine harmonics [Ramamoorthi 2001].
// NORMAL_MAP: takes normals of the high mesh, object space, instead of the low mesh's.
#include "render_albedo.glsl"
#include "render_opacity.glsl"

// Light is red, green and blue, or weights of COLOR_FUNCTIONS, four in a vector.
#ifdef COLOR_FUNCTIONS
const int functions = COLOR_FUNCTIONS;
#else
const int functions = 3;
#endif
const int vectors = (functions + 3) / 4;

struct DirectLight {
  vec4 place;  // xyz: a ball's centre, or the unit vector towards a distant light; w: a ball's radius, 0 if distant
  vec4 radiance[vectors];
};

layout(std430, binding = 1) readonly buffer PhongLights {
  vec4 phong_albedo;         // rgb; a: specular reflectance
  vec4 phong_eye;            // xyz, object space; w: shininess, the cosine's power
  vec4 phong_highlight[functions];       // rgb: what white shows of each function; not of RGB
  vec4 phong_irradiance[9 * vectors];    // divided by pi, in spherical harmonics of three bands
  DirectLight phong_lights[];
};

in vec2 surface_uv;
in vec3 surface_position;
in vec3 surface_normal;

layout(location = 0) out vec4 radiance_and_coverage;

#ifdef NORMAL_MAP
layout(binding = 5) uniform sampler2D normal_map;
vec3 shading_normal() {
  return normalize(2.0 * textureLod(normal_map, surface_uv, 0.0).xyz - 1.0);
}
#else
vec3 shading_normal() {
  return normalize(surface_normal);
}
#endif

// Evaluates the first three bands of the basis of stages/core/sh/basis.h, of one vector of functions.
vec4 diffuse_light(vec3 n, int vector) {
  vec4 light[9];
  for (int i = 0; i < 9; ++i) light[i] = phong_irradiance[i * vectors + vector];
  vec4 sum = 0.282095 * light[0] + 0.488603 * (n.y * light[1] + n.z * light[2] + n.x * light[3]);
  sum += 1.092548 * (n.x * n.y * light[4] + n.y * n.z * light[5] + n.x * n.z * light[7]);
  sum += 0.315392 * (3.0 * n.z * n.z - 1.0) * light[6];
  sum += 0.546274 * (n.x * n.x - n.y * n.y) * light[8];
  return sum;
}

void main() {
  discard_clear(surface_uv);
  vec3 normal = shading_normal();
  vec3 to_eye = normalize(phong_eye.xyz - surface_position);
  vec4 diffuse[vectors], specular[vectors];
  for (int v = 0; v < vectors; ++v) {
    diffuse[v] = diffuse_light(normal, v);
    specular[v] = vec4(0.0);
  }
  for (int k = 0; k < phong_lights.length(); ++k) {
    vec3 towards = phong_lights[k].place.xyz;
    float radius = phong_lights[k].place.w, falloff = 1.0;
    if (radius > 0.0) {
      towards -= surface_position;
      float squared = dot(towards, towards);
      falloff = min(1.0, radius * radius / squared);
      towards = towards * inversesqrt(max(squared, 1e-30));
    }
    float cosine = dot(normal, towards);
    if (cosine <= 0.0) continue;
    float shine = pow(max(0.0, dot(reflect(-towards, normal), to_eye)), phong_eye.w);
    for (int v = 0; v < vectors; ++v) {
      diffuse[v] += cosine * falloff * phong_lights[k].radiance[v];
      specular[v] += shine * falloff * phong_lights[k].radiance[v];
    }
  }
#ifdef COLOR_FUNCTIONS
  float light[functions];
  vec3 highlight = vec3(0.0);
  for (int k = 0; k < functions; ++k) {
    light[k] = diffuse[k / 4][k % 4];
    highlight += specular[k / 4][k % 4] * phong_highlight[k].rgb;
  }
#else
  vec3 light = diffuse[0].rgb, highlight = specular[0].rgb;
#endif
  vec3 color = phong_albedo.rgb * surface_color(surface_uv, light) + phong_albedo.a * highlight;
  radiance_and_coverage = vec4(color, 1.0);
}
