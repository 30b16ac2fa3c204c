// SPDX-License-Identifier: MIT
// Forward shading, for comparison: every surface computes everything when it is drawn.
layout(location = 0) out vec4 radiance_and_coverage;

void main() {
#ifdef SHADING_OPACITY
  if (is_clear(surface_uv, drawn_node)) discard;
#endif
  Surface surface = surface_of_fragment();
  kiln_varyings = varyings_of(surface);
  kiln_triangle = gl_PrimitiveID;
  apply_normal_map(surface);
  radiance_and_coverage = shaded(surface, int(node_vector(drawn_node, 6).y));
}
