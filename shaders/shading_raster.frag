// SPDX-License-Identifier: MIT
// Rasterisation: writes the appearance parameters of the nearest surface. Put behind a shader's varying parameters.
layout(location = 0) out uvec4 words;
#ifdef SHADING_VARYINGS
layout(location = 1) out vec4 varyings;
#endif

void main() {
  Surface surface = surface_of_fragment();
  words = packed_surface(surface.uv, surface.normal, surface.footprint, int(node_vector(drawn_node, 6).y), drawn_node);
#ifdef SHADING_VARYINGS
  varyings = varyings_of(surface);
#endif
}
