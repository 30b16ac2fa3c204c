// SPDX-License-Identifier: MIT
// Draws per-vertex PRT: the dot product with the light at every vertex, four coefficients per texel of vertex_transfer.
#include "common_prt.glsl"
#include "render_contributions.glsl"

layout(location = 0) uniform mat4 clip_from_object;
layout(binding = 4) uniform samplerBuffer vertex_transfer;

layout(location = 0) in vec3 position_object;
layout(location = 1) in vec2 uv;
layout(location = 3) in vec4 contributions_low;
layout(location = 4) in vec4 contributions_high;

out vec2 surface_uv;
out PRT_LIGHT vertex_radiance;

void main() {
  float contributions[PRT_SAMPLES];
  unpack_contributions(contributions_low, contributions_high, contributions);
#ifdef PRT_PLACES
  prt_places[0] = gl_VertexID;
#endif
  vertex_radiance = prt_constant(0, contributions);
  for (int layer = 0; layer < prt_layers; ++layer)
    vertex_radiance +=
        prt_decoded(0, layer, texelFetch(vertex_transfer, gl_VertexID * prt_layers + layer), contributions);
  surface_uv = uv;
  gl_Position = clip_from_object * vec4(position_object, 1.0);
}
