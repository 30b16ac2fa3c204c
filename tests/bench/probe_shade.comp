// SPDX-License-Identifier: GPL-3.0-or-later
// The shading probe of bench_gl_probes: every receiver against a batch of depth maps, one comparison each; its sums go
// into one buffer, receiver after receiver.
//   BATCH          directions
//   COEFFICIENTS   of a receiver
layout(local_size_x = 64) in;

struct Light {
  mat4 to_map;     // map coordinates and depth, 0 to 1 each
  vec4 direction;  // xyz, unit
};
layout(std140, binding = 0) uniform Lights { Light lights[BATCH]; };
layout(std140, binding = 1) uniform BasisRows { vec4 basis_rows[BATCH * (COEFFICIENTS + 3) / 4]; };
struct Receiver {
  vec4 position, normal;
};
layout(std430, binding = 0) readonly buffer Receivers { Receiver receivers[]; };
layout(std430, binding = 1) buffer Totals { float totals[]; };
layout(binding = 0) uniform sampler2DArray depth_maps;
uniform int receiver_count;
uniform float normal_offset;  // object units
uniform float depth_bias;     // in map depths

void main() {
  int r = int(gl_GlobalInvocationID.x);
  if (r >= receiver_count) return;
  vec3 normal = receivers[r].normal.xyz;
  vec4 position = vec4(receivers[r].position.xyz + normal_offset * normal, 1.0);
  float size = float(textureSize(depth_maps, 0).x);
  const int quads = (COEFFICIENTS + 3) / 4;
  vec4 sums[quads];
  for (int i = 0; i < quads; ++i) sums[i] = vec4(0.0);
  for (int d = 0; d < BATCH; ++d) {
    float cosine = dot(normal, lights[d].direction.xyz);
    if (cosine <= 0.0) continue;
    vec3 at = (lights[d].to_map * position).xyz;
    if (at.z - depth_bias > texelFetch(depth_maps, ivec3(at.xy * size, d), 0).r) continue;
    for (int i = 0; i < quads; ++i) sums[i] += cosine * basis_rows[d * quads + i];
  }
  for (int i = 0; i < COEFFICIENTS; ++i) totals[r * COEFFICIENTS + i] += sums[i / 4][i % 4];
}
