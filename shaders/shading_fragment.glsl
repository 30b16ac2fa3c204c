// SPDX-License-Identifier: MIT
// The surface at a fragment of rasterisation.
layout(location = 0) uniform int drawn_node;

in vec3 surface_position;
in vec3 surface_normal;
in vec3 surface_color;
in vec2 surface_uv;

vec3 vertex_color;  // for varying parameters

Surface surface_of_fragment() {
  vertex_color = surface_color;
  kiln_node = drawn_node;
  Surface surface;
  surface.position = surface_position;
  surface.normal = normalize(surface_normal);
  surface.uv = surface_uv;
  vec2 across = dFdx(surface_uv), up = dFdy(surface_uv);
  surface.footprint = footprint_of(footprint_code(sqrt(max(dot(across, across), dot(up, up)))));
  see(surface);
  kiln_material = int(node_vector(drawn_node, 6).x);
  return surface;
}
