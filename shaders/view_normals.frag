// SPDX-License-Identifier: MIT
// Draws normals as colours, n / 2 + 1/2 in object space; with NORMAL_MAP those of the map.
in vec2 surface_uv;
in vec3 surface_normal;

layout(location = 0) out vec4 color_and_coverage;

#ifdef NORMAL_MAP
layout(binding = 5) uniform sampler2D normal_map;
#endif

void main() {
#ifdef NORMAL_MAP
  vec3 normal = 2.0 * textureLod(normal_map, surface_uv, 0.0).xyz - 1.0;
#else
  vec3 normal = surface_normal;
#endif
  color_and_coverage = vec4(0.5 * normalize(normal) + 0.5, 1.0);
}
