// SPDX-License-Identifier: MIT
// Computes, in alpha, how far a sample is covered by an edge of its triangle. The distance to an edge is the
// barycentric coordinate over its slope on the screen.
layout(location = 1) uniform float half_width_samples;

in vec3 surface_corner;

layout(location = 0) out vec4 edge;

void main() {
  vec3 across = dFdx(surface_corner), up = dFdy(surface_corner);
  vec3 distances = surface_corner * inversesqrt(max(across * across + up * up, vec3(1e-20)));
  float nearest = min(distances.x, min(distances.y, distances.z));
  edge = vec4(clamp(half_width_samples + 0.5 - nearest, 0.0, 1.0));
}
