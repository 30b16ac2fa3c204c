// SPDX-License-Identifier: MIT
// Rasterisation: writes the appearance parameters of the nearest surface. Put behind a shader's varying parameters.
layout(location = 0) out uvec4 words;
#ifdef SHADING_VARYINGS
layout(location = 1) out vec4 varyings;
#endif
#ifdef SHADING_POINTS
layout(location = 2) out uint triangle;
#endif

void main() {
#ifdef SHADING_OPACITY
  if (is_clear(surface_uv, drawn_node)) discard;
#endif
  Surface surface = surface_of_fragment();
  words = packed_surface(surface.uv, surface.normal, surface.footprint, int(node_vector(drawn_node, 6).y), drawn_node);
#ifdef SHADING_VARYINGS
  varyings = varyings_of(surface);
#endif
#ifdef SHADING_POINTS
  triangle = uint(gl_PrimitiveID);
#endif
}
