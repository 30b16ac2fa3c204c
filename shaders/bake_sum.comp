// SPDX-License-Identifier: MIT
// Projects a block of directions: float32 sums of weights * basis rows stay in registers, and are then added to the
// totals.
//   BLOCK   directions of a full block; the weights of those beyond a smaller one are zero
//   CHUNK   coefficients of a chunk, a multiple of 4
#include "bake_receivers.glsl"
#include "bake_totals.glsl"

layout(std430, binding = 2) readonly buffer Weights {
  float weights[];  // direction after direction
};
// Basis functions at the block's directions, in a uniform block: reading it at constant addresses is free.
layout(std140, binding = 0) uniform BasisRows {
  vec4 basis_rows[BLOCK * CHUNK / 4];
};
uniform int first_coefficient;

void main() {
  int r = receiver_index();
  if (r >= receiver_count) return;
  vec4 sums[CHUNK / 4];
  for (int i = 0; i < CHUNK / 4; ++i) sums[i] = vec4(0.0);
  for (int d = 0; d < BLOCK; ++d) {
    float weight = weights[d * receiver_count + r];
    for (int i = 0; i < CHUNK / 4; ++i) sums[i] += weight * basis_rows[d * CHUNK / 4 + i];
  }
  for (int i = 0; i < CHUNK; ++i) add_to_total((first_coefficient + i) * receiver_count + r, sums[i / 4][i % 4]);
}
