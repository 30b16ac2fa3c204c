// SPDX-License-Identifier: MIT
// Shades by [Phong 1975], without shadows. Balls light by the inverse square of their distance; light without a
// direction arrives as irradiance in nine harmonics [Ramamoorthi 2001].
// NORMAL_MAP: takes normals of the high mesh, object space, instead of the low mesh's.
#include "render_albedo.glsl"
#include "render_opacity.glsl"

struct DirectLight {
  vec4 place;     // xyz: a ball's centre, or the unit vector towards a distant light; w: a ball's radius, 0 if distant
  vec4 radiance;  // rgb
};

layout(std430, binding = 1) readonly buffer PhongLights {
  vec4 phong_albedo;         // rgb; a: specular reflectance
  vec4 phong_eye;            // xyz, object space; w: shininess, the cosine's power
  vec4 phong_irradiance[9];  // rgb, divided by pi, in spherical harmonics of three bands
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

// Evaluates the first three bands of the basis of stages/core/sh/basis.h.
vec3 diffuse_light(vec3 n) {
  vec3 sum = 0.282095 * phong_irradiance[0].rgb;
  sum += 0.488603 * (n.y * phong_irradiance[1].rgb + n.z * phong_irradiance[2].rgb + n.x * phong_irradiance[3].rgb);
  sum += 1.092548 * (n.x * n.y * phong_irradiance[4].rgb + n.y * n.z * phong_irradiance[5].rgb +
                     n.x * n.z * phong_irradiance[7].rgb);
  sum += 0.315392 * (3.0 * n.z * n.z - 1.0) * phong_irradiance[6].rgb;
  sum += 0.546274 * (n.x * n.x - n.y * n.y) * phong_irradiance[8].rgb;
  return sum;
}

void main() {
  discard_clear(surface_uv);
  vec3 normal = shading_normal();
  vec3 to_eye = normalize(phong_eye.xyz - surface_position);
  vec3 diffuse = diffuse_light(normal), specular = vec3(0.0);
  for (int k = 0; k < phong_lights.length(); ++k) {
    vec3 towards = phong_lights[k].place.xyz, radiance = phong_lights[k].radiance.rgb;
    float radius = phong_lights[k].place.w;
    if (radius > 0.0) {
      towards -= surface_position;
      float squared = dot(towards, towards);
      radiance *= min(1.0, radius * radius / squared);
      towards = towards * inversesqrt(max(squared, 1e-30));
    }
    float cosine = dot(normal, towards);
    if (cosine <= 0.0) continue;
    diffuse += cosine * radiance;
    specular += pow(max(0.0, dot(reflect(-towards, normal), to_eye)), phong_eye.w) * radiance;
  }
  vec3 color = phong_albedo.rgb * surface_albedo(surface_uv) * diffuse + phong_albedo.a * specular;
  radiance_and_coverage = vec4(color, 1.0);
}
