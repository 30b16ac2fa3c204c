// SPDX-License-Identifier: MIT
// Second pass of deferred shading: computes light once for each visible sample of one asset.
#include "common_prt.glsl"
#define ALBEDO_FIRST_LEVEL
#include "render_albedo.glsl"
#include "render_contributions.glsl"

layout(early_fragment_tests) in;  // makes the stencil test run before the shader

layout(location = 3) uniform float asset_number;
layout(binding = 6) uniform sampler2D uv_and_asset;
layout(binding = 7) uniform sampler2D contributions_low;
layout(binding = 8) uniform sampler2D contributions_high;

layout(location = 0) out vec4 radiance_and_coverage;

void main() {
  ivec2 place = ivec2(gl_FragCoord.xy);
  vec4 appearance = texelFetch(uv_and_asset, place, 0);
  if (appearance.z != asset_number) discard;
  float contributions[PRT_SAMPLES];
#if PRT_SAMPLES == 1
  unpack_contributions(vec4(1.0), vec4(0.0), contributions);
#else
  unpack_contributions(texelFetch(contributions_low, place, 0), texelFetch(contributions_high, place, 0), contributions);
#endif
  radiance_and_coverage = vec4(surface_color(appearance.xy, prt_exit_radiance(appearance.xy, contributions)), 1.0);
}
