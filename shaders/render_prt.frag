// SPDX-License-Identifier: MIT
// Draws textured PRT, plain or compressed.
#include "common_prt.glsl"
#include "render_albedo.glsl"
#include "render_contributions.glsl"
#include "render_opacity.glsl"

in vec2 surface_uv;
#if PRT_SAMPLES > 1
in vec4 surface_contributions_low;
in vec4 surface_contributions_high;
#else
const vec4 surface_contributions_low = vec4(1.0), surface_contributions_high = vec4(0.0);
#endif

layout(location = 0) out vec4 radiance_and_coverage;

void main() {
  discard_clear(surface_uv);
  float contributions[PRT_SAMPLES];
  unpack_contributions(surface_contributions_low, surface_contributions_high, contributions);
  radiance_and_coverage = vec4(surface_albedo(surface_uv) * prt_exit_radiance(surface_uv, contributions), 1.0);
}
