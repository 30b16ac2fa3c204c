// SPDX-License-Identifier: MIT
// Draws a mesh into visibility maps: one map, a layer, per instance.
#extension GL_ARB_shader_viewport_layer_array : require

/// A node as the map at a point sees it.
struct Instance {
  vec4 right, up, forward;  // rows: from object space to the map's, sideways in half-widths at distance 1
  int layer;
  float nearest;  // distance along the map's axis; what is nearer is cut off: it touches the point
};
layout(std430, binding = 0) readonly buffer Instances {
  Instance instances[];
};
layout(location = 0) in vec3 position_object;
uniform int first_instance;
uniform float depth_unit;  // distance; what is nearer has a depth of 1 (GL_DEPTH_CLAMP)
out float gl_ClipDistance[1];

void main() {
  Instance seen = instances[first_instance + gl_InstanceID];
  vec4 position = vec4(position_object, 1.0);
  // Depth is depth_unit / distance along the map's axis: towards 0 far away, and equally exact anywhere.
  gl_Position = vec4(dot(seen.right, position), dot(seen.up, position), depth_unit, dot(seen.forward, position));
  gl_ClipDistance[0] = gl_Position.w - seen.nearest;
  gl_Layer = seen.layer;
}
