// SPDX-License-Identifier: MIT
#include "render_albedo.glsl"
#include "render_opacity.glsl"

in vec2 surface_uv;
in vec3 vertex_radiance;

layout(location = 0) out vec4 radiance_and_coverage;

void main() {
  discard_clear(surface_uv);
  radiance_and_coverage = vec4(surface_albedo(surface_uv) * vertex_radiance, 1.0);
}
