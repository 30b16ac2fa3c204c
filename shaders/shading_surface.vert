// SPDX-License-Identifier: MIT
// Places a node's mesh. SHADING_DEPTH: for shadow maps alone.
layout(location = 0) uniform int drawn_node;
layout(location = 0) in vec3 position_object;
#ifdef SHADING_DEPTH
layout(location = 1) uniform mat4 clip_of_light;
#ifdef SHADING_OPACITY
layout(location = 1) in vec2 uv;
out vec2 surface_uv;
#endif

void main() {
#ifdef SHADING_OPACITY
  surface_uv = uv;
#endif
  gl_Position = clip_of_light * vec4(from_object(vec4(position_object, 1.0), drawn_node), 1.0);
}
#else
layout(location = 1) in vec2 uv;
layout(location = 2) in vec3 normal_object;
layout(location = 5) in vec3 color;

out vec3 surface_position;
out vec3 surface_normal;
out vec3 surface_color;
out vec2 surface_uv;

void main() {
  surface_position = from_object(vec4(position_object, 1.0), drawn_node);
  surface_normal = from_object(vec4(normal_object, 0.0), drawn_node);
  surface_uv = uv;
  surface_color = color;
  gl_Position = clip_from_scene * vec4(surface_position, 1.0);
  gl_ClipDistance[0] = dot(cut_plane, vec4(surface_position, 1.0));
}
#endif
