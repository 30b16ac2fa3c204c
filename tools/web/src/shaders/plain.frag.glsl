// SPDX-License-Identifier: MIT
// Shades without transfer, and so without shadows: the light's irradiance in nine harmonics [Ramamoorthi 2001], and
// distant lights by the cosine. Also shows normals and charts.
#include <common>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>

varying vec2 kiln_uv;
varying vec3 kiln_normal;
varying vec3 kiln_eye;
#ifdef KILN_TANGENTS
varying vec4 kiln_tangent;
#endif
#ifdef KILN_CHARTS
varying vec3 kiln_chart_color;
#endif
uniform vec3 kiln_tint;
uniform vec3 kiln_irradiance[9];  // divided by pi
uniform vec3 kiln_towards[8];     // unit vectors, object space
uniform vec3 kiln_colors[8];
#ifdef KILN_ALBEDO
uniform sampler2D kiln_albedo;
#endif
#ifdef KILN_OPACITY
uniform sampler2D kiln_opacity;
#endif
#ifdef KILN_NORMALS
uniform sampler2D kiln_normals;
#endif

vec3 shading_normal() {
#ifdef KILN_NORMALS
  vec3 n = 2.0 * textureLod(kiln_normals, kiln_uv, 0.0).xyz - 1.0;
#ifdef KILN_TANGENTS
  // MikkTSpace: neither vector is normalised between vertices, and the third is their product.
  vec3 bitangent = kiln_tangent.w * cross(kiln_normal, kiln_tangent.xyz);
  n = n.x * kiln_tangent.xyz + n.y * bitangent + n.z * kiln_normal;
#endif
  return normalize(n);
#else
  return normalize(kiln_normal);
#endif
}

vec3 diffuse_light(vec3 n) {
  vec3 sum = 0.282095 * kiln_irradiance[0];
  sum += 0.488603 * (n.y * kiln_irradiance[1] + n.z * kiln_irradiance[2] + n.x * kiln_irradiance[3]);
  sum += 1.092548 * (n.x * n.y * kiln_irradiance[4] + n.y * n.z * kiln_irradiance[5] + n.x * n.z * kiln_irradiance[7]);
  sum += 0.315392 * (3.0 * n.z * n.z - 1.0) * kiln_irradiance[6];
  sum += 0.546274 * (n.x * n.x - n.y * n.y) * kiln_irradiance[8];
  for (int k = 0; k < 8; ++k) sum += max(0.0, dot(n, kiln_towards[k])) * kiln_colors[k];
  return sum;
}

void main() {
  #include <clipping_planes_fragment>
  #include <logdepthbuf_fragment>
#ifdef KILN_OPACITY
  if (textureLod(kiln_opacity, kiln_uv, 0.0).r < 0.5) discard;
#endif
  vec3 n = shading_normal();
#if defined(KILN_SHOW_NORMALS)
  // The picture holds n / 2 + 1/2 as it stands, so it is decoded here and encoded again below.
  vec3 shown = 0.5 * n + 0.5;
  gl_FragColor = vec4(mix(shown / 12.92, pow((shown + 0.055) / 1.055, vec3(2.4)), step(0.04045, shown)), 1.0);
#elif defined(KILN_CHARTS)
  float facing = abs(dot(normalize(kiln_normal), normalize(kiln_eye)));
  gl_FragColor = vec4(kiln_chart_color * (0.45 + 0.55 * facing), 1.0);
#else
  vec3 color = kiln_tint * diffuse_light(n);
#ifdef KILN_ALBEDO
  color *= texture2D(kiln_albedo, kiln_uv).rgb;
#endif
  gl_FragColor = vec4(max(color, 0.0), 1.0);
  #include <tonemapping_fragment>
#endif
  #include <colorspace_fragment>
  #include <fog_fragment>
}
