// SPDX-License-Identifier: MIT
// Adds a picture of one sample a pixel to the picture of all.
layout(location = 0) uniform float weight;
layout(binding = 3) uniform sampler2D sampled;
layout(location = 0) out vec4 radiance_and_coverage;

void main() {
  radiance_and_coverage = weight * texelFetch(sampled, ivec2(gl_FragCoord.xy), 0);
}
