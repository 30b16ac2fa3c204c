// SPDX-License-Identifier: MIT
// Draws an occluder as seen along one direction: one layer of the depth maps per instance.
#ifdef HAS_VERTEX_LAYER
#extension GL_ARB_shader_viewport_layer_array : require
#endif
#include "bake_views.glsl"

layout(location = 0) in vec3 position_object;
uniform int first_layer;

void main() {
  int layer = first_layer + gl_InstanceID;
  vec3 at = map_coordinates(layer, position_object);
  // Clip space has depth 0 to 1 (glClipControl), so the map stores `at.z` itself.
  gl_Position = vec4(2.0 * at.xy - 1.0, at.z, 1.0);
#ifdef HAS_VERTEX_LAYER
  gl_Layer = layer;
#endif
}
