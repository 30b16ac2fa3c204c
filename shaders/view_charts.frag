// SPDX-License-Identifier: MIT
// Draws each chart in a colour of its own, darker where the surface turns away from the eye.
layout(location = 1) uniform vec3 eye_object;

in vec3 surface_position;
in vec3 surface_normal;
flat in vec3 surface_chart;

layout(location = 0) out vec4 color_and_coverage;

void main() {
  float facing = abs(dot(normalize(surface_normal), normalize(eye_object - surface_position)));
  color_and_coverage = vec4(surface_chart * (0.45 + 0.55 * facing), 1.0);
}
