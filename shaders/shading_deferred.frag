// SPDX-License-Identifier: MIT
// Shades the visible samples of some shaders, once each. Put behind these: their functions and parts.
layout(binding = 3) uniform usampler2D surface_words;
layout(binding = 4) uniform sampler2D surface_varyings;
layout(binding = 5) uniform sampler2D surface_depth;

layout(location = 0) out vec4 radiance_and_coverage;

void main() {
  ivec2 sample_place = ivec2(gl_FragCoord.xy);
  uvec4 words = texelFetch(surface_words, sample_place, 0);
  int shader = shader_of(words.w), node = int(words.w & 0xffffu);
  if (!is_among(shader)) discard;
  vec4 clip = vec4(gl_FragCoord.xy / picture_size, texelFetch(surface_depth, sample_place, 0).x, 1.0);
  vec4 place = scene_from_clip * vec4(2.0 * clip.xyz - 1.0, 1.0);
  Surface surface;
  surface.position = place.xyz / place.w;
  surface.object = times(nodes[node].object_from_scene, vec4(surface.position, 1.0));
  surface.normal = from_octahedral(unpackSnorm2x16(words.z));
  surface.to_eye = normalize(eye_and_weight.xyz - surface.position);
  surface.uv = uintBitsToFloat(words.xy);
  surface.footprint = footprint_of(words.w >> 16 & 0xffu);
#ifdef SHADING_VARYINGS
  kiln_varyings = texelFetch(surface_varyings, sample_place, 0);
#endif
  radiance_and_coverage = shaded(surface, shader, node) * eye_and_weight.w;
}
