// SPDX-License-Identifier: MIT
// Draws the picture into the window, over a plain backdrop where it is transparent.
layout(location = 0) uniform vec2 window_pixels;
layout(binding = 0) uniform sampler2D picture;

layout(location = 0) out vec4 color;

void main() {
  vec2 from_middle = gl_FragCoord.xy / window_pixels - 0.5;
  float grey = mix(0.235, 0.125, smoothstep(0.0, 0.75, length(from_middle)));
  // Adds noise of half a step, so that gradients show no rings.
  float noise = fract(sin(dot(gl_FragCoord.xy, vec2(12.9898, 78.233))) * 43758.5453) - 0.5;
  vec4 pixel = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
  color = vec4(mix(vec3(grey + noise / 255.0), pixel.rgb, pixel.a), 1.0);
}
