// SPDX-License-Identifier: MIT
// Draws a surface as the light sees it: one direction per instance.
#include "bake_views.glsl"

layout(location = 0) in vec3 position_object;
flat out int layer;

void main() {
  layer = gl_InstanceID;
  vec3 at = map_coordinates(layer, position_object);
  // Clip space has depth 0 to 1 (glClipControl), so that gl_FragCoord.z is `at.z` itself.
  gl_Position = vec4(2.0 * at.xy - 1.0, at.z, 1.0);
}
