// SPDX-License-Identifier: MIT
// Averages samples into the pixels of the finished picture, with straight alpha, as tools/render/output/picture.h does.
//
// VIEW_RADIANCE: maps linear radiance through exposure and tone curve.
// VIEW_SIGNED: maps a number, or its difference from that of another picture, from blue (below 0) by grey to red.
// Neither: keeps colours as they are.
// VIEW_EDGES: adds the edges of the mesh.
layout(location = 0) uniform int supersample;
layout(location = 1) uniform float gain;      // 2^stops, or the factor that turns the largest number to be shown into 1
layout(location = 2) uniform vec4 background; // linear rgb; a is 1 if there is one, else the picture is transparent
layout(location = 3) uniform bool srgb_tone;
layout(location = 4) uniform vec3 signed_weights;  // weights of red, green and blue in the number
layout(binding = 0) uniform sampler2D picture_samples;
layout(binding = 1) uniform sampler2D reference_samples;
layout(binding = 2) uniform sampler2D edge_samples;

layout(location = 0) out vec4 pixel;

vec4 mean_of(sampler2D samples) {
  ivec2 first = ivec2(gl_FragCoord.xy) * supersample;
  vec4 sum = vec4(0.0);
  for (int j = 0; j < supersample; ++j)
    for (int i = 0; i < supersample; ++i) sum += texelFetch(samples, first + ivec2(i, j), 0);
  return sum / float(supersample * supersample);
}

vec3 srgb_from_linear(vec3 linear) {
  vec3 clamped = clamp(linear, 0.0, 1.0);
  return mix(1.055 * pow(clamped, vec3(1.0 / 2.4)) - 0.055, 12.92 * clamped, lessThanEqual(clamped, vec3(0.0031308)));
}

vec3 signed_color(float value) {
  const vec3 nothing = vec3(0.84), above = vec3(0.76, 0.10, 0.08), below = vec3(0.10, 0.27, 0.74);
  return mix(nothing, value > 0.0 ? above : below, min(abs(value), 1.0));
}

void main() {
  vec4 mean = mean_of(picture_samples);
  vec3 color = mean.rgb;
  float alpha = mean.a;
#if defined(VIEW_SIGNED)
  float value = dot(signed_weights, mean.rgb - mean_of(reference_samples).rgb);
  color = signed_color(gain * value / max(alpha, 1e-6));
#elif defined(VIEW_RADIANCE)
  if (background.a > 0.0) {
    color = max(gain * color, 0.0) + (1.0 - alpha) * background.rgb;
    alpha = 1.0;
  } else {
    color = gain * color / max(alpha, 1e-6);
  }
  if (srgb_tone) color = srgb_from_linear(color);
#else
  color /= max(alpha, 1e-6);
#endif
#ifdef VIEW_EDGES
  // Draws dark edges on light colours and light edges on dark ones, so that no colour hides them.
  color = clamp(color, 0.0, 1.0);
  float brightness = dot(vec3(0.2126, 0.7152, 0.0722), color);
  float edge = mean_of(edge_samples).a;
  color = mix(color, brightness > 0.45 ? vec3(0.05) : vec3(0.92), 0.6 * edge);
#endif
  pixel = vec4(clamp(color, 0.0, 1.0), alpha);
}
