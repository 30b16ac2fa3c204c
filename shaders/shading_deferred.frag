// SPDX-License-Identifier: MIT
// Shades the visible samples of some shaders, once each. Put behind these: their functions and parts.
layout(binding = 3) uniform usampler2D surface_words;
layout(binding = 4) uniform sampler2D surface_varyings;
layout(binding = 5) uniform sampler2D surface_depth;
#ifdef SHADING_POINTS
layout(binding = 9) uniform usampler2D surface_triangles;
#endif

layout(location = 0) out vec4 radiance_and_coverage;

void main() {
  ivec2 sample_place = ivec2(gl_FragCoord.xy);
  uvec4 words = texelFetch(surface_words, sample_place, 0);
  int shader = shader_of(words.w);
  if (!is_among(shader)) discard;
  kiln_node = int(words.w & 0xffffu);
  // Depths are as they are in clip space: 1 at the near plane, 0 at the far one.
  float depth = texelFetch(surface_depth, sample_place, 0).x;
  vec4 place = scene_from_clip * vec4(2.0 * gl_FragCoord.xy / picture_size - 1.0, depth, 1.0);
  Surface surface;
  surface.position = place.xyz / place.w;
  surface.normal = from_octahedral(unpackSnorm2x16(words.z));
  surface.uv = uintBitsToFloat(words.xy);
  surface.footprint = footprint_of(words.w >> 16 & 0xffu);
  see(surface);
#ifdef SHADING_VARYINGS
  kiln_varyings = texelFetch(surface_varyings, sample_place, 0);
#endif
#ifdef SHADING_POINTS
  kiln_triangle = int(texelFetch(surface_triangles, sample_place, 0).x);
#endif
  apply_normal_map(surface);
  radiance_and_coverage = shaded(surface, shader) * eye_and_weight.w;
}
