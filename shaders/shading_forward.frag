// SPDX-License-Identifier: MIT
// Forward shading, for comparison: every surface computes everything when it is drawn.
layout(location = 0) out vec4 radiance_and_coverage;

void main() {
  Surface surface = surface_of_fragment();
  kiln_varyings = varyings_of(surface);
  radiance_and_coverage = shaded(surface, int(node_vector(drawn_node, 6).y));
}
