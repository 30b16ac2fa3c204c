// SPDX-License-Identifier: MIT
// Writes the radiance of a white surface, and coverage.
in float vertex_radiance;
out vec4 color;

void main() { color = vec4(vec3(max(vertex_radiance, 0.0)), 1.0); }
