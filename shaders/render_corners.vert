// SPDX-License-Identifier: MIT
// Draws triangles corner after corner, for light that is computed at every vertex: says which three vertices a point
// lies between, and the share of each.
layout(location = 0) uniform mat4 clip_from_object;
layout(binding = 12) uniform usamplerBuffer triangle_vertices;

layout(location = 0) in vec3 position_object;
layout(location = 1) in vec2 uv;

out vec2 surface_uv;
out vec3 surface_shares;
flat out ivec3 surface_vertices;

void main() {
  surface_uv = uv;
  surface_vertices = ivec3(texelFetch(triangle_vertices, gl_VertexID / 3).xyz);
  surface_shares = vec3(0.0);
  surface_shares[gl_VertexID % 3] = 1.0;
  gl_Position = clip_from_object * vec4(position_object, 1.0);
}
