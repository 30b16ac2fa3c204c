// SPDX-License-Identifier: MIT
// Albedo of the surface, which transfer does not include. Stored in sRGB, which the texture unit decodes.
#ifdef ALBEDO_MAP
layout(binding = 3) uniform sampler2D albedo_map;
vec3 surface_albedo(vec2 uv) {
  return textureLod(albedo_map, uv, 0.0).rgb;
}
#else
vec3 surface_albedo(vec2 uv) {
  return vec3(1.0);
}
#endif
