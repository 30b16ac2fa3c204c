// SPDX-License-Identifier: MIT
// Draws textured PRT, plain or compressed.
#include "common_prt.glsl"
#include "render_albedo.glsl"
#include "render_contributions.glsl"
#include "render_opacity.glsl"

in vec2 surface_uv;
#ifdef PRT_PLACES
in vec3 surface_shares;
flat in ivec3 surface_vertices;
#elif PRT_SAMPLES > 1
in vec4 surface_contributions_low;
in vec4 surface_contributions_high;
#else
const vec4 surface_contributions_low = vec4(1.0), surface_contributions_high = vec4(0.0);
#endif

layout(location = 0) out vec4 radiance_and_coverage;

void main() {
  discard_clear(surface_uv);
  float contributions[PRT_SAMPLES];
#ifdef PRT_PLACES
  for (int k = 0; k < 3; ++k) {
    contributions[k] = surface_shares[k];
    prt_places[k] = surface_vertices[k];
  }
#else
  unpack_contributions(surface_contributions_low, surface_contributions_high, contributions);
#endif
  radiance_and_coverage = vec4(surface_color(surface_uv, prt_exit_radiance(surface_uv, contributions)), 1.0);
}
