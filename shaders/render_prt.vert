layout(location = 0) uniform mat4 clip_from_object;

layout(location = 0) in vec3 position_object;
layout(location = 1) in vec2 uv;

out vec2 surface_uv;

void main() {
  surface_uv = uv;
  gl_Position = clip_from_object * vec4(position_object, 1.0);
}
