// SPDX-License-Identifier: MIT
layout(location = 0) uniform mat4 clip_from_object;

layout(location = 0) in vec3 position_object;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec3 normal_object;
layout(location = 3) in vec4 contributions_low;
layout(location = 4) in vec4 contributions_high;

out vec2 surface_uv;
#ifdef PHONG
out vec3 surface_position;
out vec3 surface_normal;
#elif PRT_SAMPLES > 1
out vec4 surface_contributions_low;
out vec4 surface_contributions_high;
#endif

void main() {
  surface_uv = uv;
#ifdef PHONG
  surface_position = position_object;
  surface_normal = normal_object;
#elif PRT_SAMPLES > 1
  surface_contributions_low = contributions_low;
  surface_contributions_high = contributions_high;
#endif
  gl_Position = clip_from_object * vec4(position_object, 1.0);
}
