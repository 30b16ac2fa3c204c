// SPDX-License-Identifier: MIT
// A panel, pixel for pixel, straight alpha.
layout(location = 0) uniform ivec2 corner;  // its lower left one in the window, pixels
layout(binding = 0) uniform sampler2D panel;

layout(location = 0) out vec4 colour;

void main() {
  colour = texelFetch(panel, ivec2(gl_FragCoord.xy) - corner, 0);
}
