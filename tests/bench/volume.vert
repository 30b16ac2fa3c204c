// SPDX-License-Identifier: MIT
// Places a vertex of the scene; w = 0 is a point at infinity, where shadow volumes end.
layout(location = 0) in vec4 position_scene;
layout(location = 1) in float radiance;
uniform mat4 clip_from_scene;
out float vertex_radiance;

void main() {
  vertex_radiance = radiance;
  gl_Position = clip_from_scene * position_scene;
}
