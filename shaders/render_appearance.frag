// SPDX-License-Identifier: MIT
// First pass of deferred shading: writes what shading needs of the nearest surface, without any light: PixelFlow's
// appearance parameters [Lastra 1995].
#include "render_opacity.glsl"

layout(location = 3) uniform float asset_number;  // counted from 1

in vec2 surface_uv;
layout(location = 0) out vec4 uv_and_asset;

#if PRT_SAMPLES == 1
void main() {
  discard_clear(surface_uv);
  uv_and_asset = vec4(surface_uv, asset_number, 1.0);
}
#else
in vec4 surface_contributions_low;
in vec4 surface_contributions_high;
layout(location = 1) out vec4 contributions_low;
layout(location = 2) out vec4 contributions_high;

void main() {
  discard_clear(surface_uv);
  uv_and_asset = vec4(surface_uv, asset_number, 1.0);
  contributions_low = surface_contributions_low;
  contributions_high = surface_contributions_high;
}
#endif
