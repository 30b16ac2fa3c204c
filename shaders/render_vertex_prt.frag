// SPDX-License-Identifier: MIT
#include "common_prt.glsl"
#include "render_albedo.glsl"
#include "render_opacity.glsl"

in vec2 surface_uv;
in PRT_LIGHT vertex_radiance;

layout(location = 0) out vec4 radiance_and_coverage;

void main() {
  discard_clear(surface_uv);
  radiance_and_coverage = vec4(surface_color(surface_uv, vertex_radiance), 1.0);
}
