// SPDX-License-Identifier: MIT
// Albedo of the surface, which transfer does not include. Stored in sRGB, which the texture unit decodes. Its levels, if
// it has some, go by how uvs differ between neighbouring pixels; with ALBEDO_FIRST_LEVEL, which is for passes in which
// these may be of other surfaces, the first level serves all.
#ifdef ALBEDO_MAP
layout(binding = 3) uniform sampler2D albedo_map;
vec3 surface_albedo(vec2 uv) {
#ifdef ALBEDO_FIRST_LEVEL
  return textureLod(albedo_map, uv, 0.0).rgb;
#else
  return texture(albedo_map, uv).rgb;
#endif
}
#else
vec3 surface_albedo(vec2 uv) {
  return vec3(1.0);
}
#endif

// COLOR_FUNCTIONS: number of functions that light is a sum of. A surface's colour under each is then a product with its
// albedo, plus the difference that surface_colors holds by the albedo in sRGB's encoding: the functions' tables stand
// one on another, and are read half a texel from their borders.
#ifdef COLOR_FUNCTIONS
layout(binding = 10) uniform sampler3D surface_colors;
layout(location = 8) uniform mat3 surface_products[COLOR_FUNCTIONS];

// MEASURED_MATERIALS: some of the surface are materials whose reflectance was measured; measured_at has their numbers
// by texel of the planes, 0 elsewhere, measured_colors what each, from 1, shows of each function.
#ifdef MEASURED_MATERIALS
layout(binding = 11) uniform usampler2D measured_at;
layout(binding = 13) uniform sampler2D measured_colors;

int measured_material(vec2 uv) {
  ivec2 size = textureSize(measured_at, 0);
  return int(texelFetch(measured_at, clamp(ivec2(floor(uv * vec2(size))), ivec2(0), size - 1), 0).r);
}
#endif

vec3 surface_color(vec2 uv, float light[COLOR_FUNCTIONS]) {
#ifdef MEASURED_MATERIALS
  int material = measured_material(uv);
  if (material > 0) {
    vec3 measured = vec3(0.0);
    for (int k = 0; k < COLOR_FUNCTIONS; ++k)
      measured += light[k] * texelFetch(measured_colors, ivec2(material - 1, k), 0).rgb;
    return measured;
  }
#endif
  vec3 albedo = surface_albedo(uv);
  vec3 encoded = mix(12.92 * albedo, 1.055 * pow(max(albedo, 0.003), vec3(1.0 / 2.4)) - 0.055,
                     greaterThan(albedo, vec3(0.0031308)));
  float side = float(textureSize(surface_colors, 0).x);
  vec3 place = (clamp(encoded, 0.0, 1.0) * (side - 1.0) + 0.5) / (side * vec3(1.0, 1.0, COLOR_FUNCTIONS));
  vec3 color = vec3(0.0);
  for (int k = 0; k < COLOR_FUNCTIONS; ++k) {
    color += light[k] * (surface_products[k] * albedo + textureLod(surface_colors, place, 0.0).rgb);
    place.z += 1.0 / float(COLOR_FUNCTIONS);
  }
  return color;
}

#ifdef PRT_LIGHT
vec3 surface_color(vec2 uv, PRT_LIGHT light) {
  float weights[COLOR_FUNCTIONS];
#if COLOR_FUNCTIONS == 1
  weights[0] = light;
#elif COLOR_FUNCTIONS <= 4
  for (int k = 0; k < COLOR_FUNCTIONS; ++k) weights[k] = light[k];
#else
  const int column = COLOR_FUNCTIONS <= 6 ? 3 : 4;
  for (int k = 0; k < COLOR_FUNCTIONS; ++k) weights[k] = light[k / column][k % column];
#endif
  return surface_color(uv, weights);
}
#endif
#else
vec3 surface_color(vec2 uv, vec3 light) {
  return surface_albedo(uv) * light;
}
#endif
