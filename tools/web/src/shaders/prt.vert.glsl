// SPDX-License-Identifier: MIT
// Places the surface; per vertex, also computes its light (shaders/render_vertex_prt.vert of the runtime).
#include <common>
#include <fog_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>

varying vec2 kiln_uv;

#ifdef KILN_VERTICES
uniform highp usampler2D kiln_transfer;
uniform highp sampler2D kiln_light;
uniform int kiln_layers;
uniform float kiln_largest;
varying vec3 kiln_radiance;

vec3 kiln_vertex_radiance() {
  vec3 radiance = texelFetch(kiln_light, ivec2(0), 0).rgb;
  int width = textureSize(kiln_transfer, 0).x;
  for (int layer = 0; layer < kiln_layers; ++layer) {
    int place = gl_VertexID * kiln_layers + layer, at = 1 + 3 * layer;
    vec4 stored = vec4(texelFetch(kiln_transfer, ivec2(place % width, place / width), 0)) / kiln_largest;
    for (int c = 0; c < 3; ++c)
      radiance[c] += dot(texelFetch(kiln_light, ivec2((at + c) % KILN_LIGHT_WIDTH, (at + c) / KILN_LIGHT_WIDTH), 0), stored);
  }
  return radiance;
}
#endif

void main() {
  kiln_uv = uv;
#ifdef KILN_VERTICES
  kiln_radiance = kiln_vertex_radiance();
#endif
  #include <begin_vertex>
  #include <project_vertex>
  #include <logdepthbuf_vertex>
  #include <clipping_planes_vertex>
  vec4 worldPosition = modelMatrix * vec4(transformed, 1.0);
  #include <fog_vertex>
}
