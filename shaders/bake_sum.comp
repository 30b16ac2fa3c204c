// Projects a batch: totals += weights * basis rows, a chunk of coefficients per workgroup row. The batch's sums stay in
// registers, and the totals are read and written once per batch.
//   BATCH   directions of a full batch; the rows of those beyond a smaller one are zero
//   CHUNK   coefficients of a chunk, a multiple of 4
layout(local_size_x = 64) in;

layout(std430, binding = 2) readonly buffer Weights {
  float weights[];  // direction after direction
};
layout(std430, binding = 3) buffer Totals {
  float totals[];  // plane after plane, whole chunks
};
// Basis functions at the batch's directions times the quadrature weight. A uniform block, whose constant addresses cost nothing.
layout(std140, binding = 0) uniform BasisRows {
  vec4 basis_rows[BATCH * CHUNK / 4];
};
uniform int receiver_count;
uniform int first_coefficient;

void main() {
  int r = int(gl_GlobalInvocationID.x);
  if (r >= receiver_count) return;
  vec4 sums[CHUNK / 4];
  for (int i = 0; i < CHUNK / 4; ++i) sums[i] = vec4(0.0);
  for (int d = 0; d < BATCH; ++d) {
    float weight = weights[d * receiver_count + r];
    for (int i = 0; i < CHUNK / 4; ++i) sums[i] += weight * basis_rows[d * CHUNK / 4 + i];
  }
  for (int i = 0; i < CHUNK; ++i) totals[(first_coefficient + i) * receiver_count + r] += sums[i / 4][i % 4];
}
