// SPDX-License-Identifier: MIT
// Directions of a batch and the frames of their depth maps, laid out as in stages/bake/egl/shadow_frame.h.
struct View {
  vec4 row_u;
  vec4 row_v;
  vec4 row_depth;
  vec4 direction;  // xyz: unit vector towards the light; w: size of a depth map's texel in object units
  vec4 extent;     // of the map in object units: width, height, depth
};

layout(std430, binding = 0) readonly buffer Views {
  View views[];
};

// Returns the map coordinates (0 to 1) and depth (0 is nearest to the light) of a point.
vec3 map_coordinates(int layer, vec3 position_object) {
  vec4 p = vec4(position_object, 1.0);
  return vec3(dot(views[layer].row_u, p), dot(views[layer].row_v, p), dot(views[layer].row_depth, p));
}
