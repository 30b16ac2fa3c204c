// SPDX-License-Identifier: MIT
// Opacity of the surface: where it is below a half nothing is there.
#ifdef OPACITY_MAP
layout(binding = 9) uniform sampler2D opacity_map;
void discard_clear(vec2 uv) {
  if (textureLod(opacity_map, uv, 0.0).r < 0.5) discard;
}
#else
void discard_clear(vec2 uv) {
}
#endif
