// SPDX-License-Identifier: GPL-3.0-or-later
// The depth probe of bench_gl_probes: a mesh seen along one direction.
layout(location = 0) in vec3 position_object;
uniform mat4 to_map;  // map coordinates and depth, 0 to 1 each

void main() {
  vec3 at = (to_map * vec4(position_object, 1.0)).xyz;
  gl_Position = vec4(2.0 * at.xy - 1.0, at.z, 1.0);  // glClipControl has depth 0 to 1
}
