// SPDX-License-Identifier: MIT
// Albedo of the surface, which transfer does not include. Stored in sRGB, which the texture unit decodes. Its levels, if
// it has some, go by how uvs differ between neighbouring pixels; with ALBEDO_FIRST_LEVEL, which is for passes in which
// these may be of other surfaces, the first level serves all.
#ifdef ALBEDO_MAP
layout(binding = 3) uniform sampler2D albedo_map;
vec3 surface_albedo(vec2 uv) {
#ifdef ALBEDO_FIRST_LEVEL
  return textureLod(albedo_map, uv, 0.0).rgb;
#else
  return texture(albedo_map, uv).rgb;
#endif
}
#else
vec3 surface_albedo(vec2 uv) {
  return vec3(1.0);
}
#endif
