// SPDX-License-Identifier: MIT
// Draws every corner of every triangle, three in a row, for inspection: triangles share nothing.
layout(location = 0) uniform mat4 clip_from_object;

layout(location = 0) in vec3 position_object;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec3 normal_object;
layout(location = 3) in vec3 chart_color;

out vec2 surface_uv;
out vec3 surface_position;
out vec3 surface_normal;
out vec3 surface_corner;  // barycentric
flat out vec3 surface_chart;

void main() {
  surface_uv = uv;
  surface_position = position_object;
  surface_normal = normal_object;
  surface_chart = chart_color;
  int corner = gl_VertexID % 3;
  surface_corner = vec3(corner == 0, corner == 1, corner == 2);
  gl_Position = clip_from_object * vec4(position_object, 1.0);
}
