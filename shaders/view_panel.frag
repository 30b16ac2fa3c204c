// SPDX-License-Identifier: MIT
// Draws a panel pixel for pixel, with straight alpha.
layout(location = 0) uniform ivec2 corner;  // lower left corner in the window, pixels
layout(binding = 0) uniform sampler2D panel;

layout(location = 0) out vec4 color;

void main() {
  color = texelFetch(panel, ivec2(gl_FragCoord.xy) - corner, 0);
}
