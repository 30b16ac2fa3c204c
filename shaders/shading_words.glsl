// SPDX-License-Identifier: MIT
// What rasterisation writes of the nearest surface ([Lastra 1995], figure 8), 16 bytes a sample beside its depth:
//   x, y   uv, float32
//   z      unit normal in the scene's space, octahedral, 2 x 16 bits
//   w      number of the shader, from 1 (8 bits); logarithm of the footprint (8); number of the node (16). 0: nothing.
// Varying parameters that a shader declares are 8 bytes more, four 16-bit floats, if any shader of the scene has some.

vec2 octahedral(vec3 n) {
  vec2 flat_place = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
  vec2 folded = (1.0 - abs(flat_place.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(flat_place, vec2(0.0)));
  return n.z < 0.0 ? folded : flat_place;
}

vec3 from_octahedral(vec2 place) {
  vec3 n = vec3(place, 1.0 - abs(place.x) - abs(place.y));
  float below = max(-n.z, 0.0);
  n.xy -= below * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(n.xy, vec2(0.0)));
  return normalize(n);
}

// Footprints of 2^-24 to 2^7.9 in steps of an eighth of a level of a mip map.
uint footprint_code(float footprint) {
  return uint(clamp(round(8.0 * (log2(max(footprint, 1e-12)) + 24.0)), 0.0, 255.0));
}

float footprint_of(uint code) {
  return exp2(float(code) / 8.0 - 24.0);
}

uvec4 packed_surface(vec2 uv, vec3 normal, float footprint, int shader, int node) {
  return uvec4(floatBitsToUint(uv), packSnorm2x16(octahedral(normal)),
               uint(shader + 1) << 24 | footprint_code(footprint) << 16 | uint(node));
}

// Returns the shader of a sample, -1 where nothing is.
int shader_of(uint word) {
  return int(word >> 24) - 1;
}
