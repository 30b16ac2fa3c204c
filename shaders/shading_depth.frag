// SPDX-License-Identifier: MIT
// Draws depths alone; what is clear casts no shadow.
#ifdef SHADING_OPACITY
layout(location = 0) uniform int drawn_node;
in vec2 surface_uv;

void main() {
  if (is_clear(surface_uv, drawn_node)) discard;
}
#else
void main() {
}
#endif
