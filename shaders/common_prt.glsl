// Exit radiance from a stack of transfer coefficients under a light. With t_i = min_i + s_i (max_i - min_i), s_i the
// stored value of plane i (0 to 1) and L_i the light's coefficient,
//
//   albedo sum_i L_i t_i  =  albedo sum_i L_i min_i  +  sum_i (albedo L_i (max_i - min_i)) s_i,
//
// the first sum being prt_constant and the brackets the scales, which plane_weights (stages/relight/relight.h) computes
// once per light. A plane of a colour's own transfer has zeros for the other colours; a plane of one transfer for all
// colours, or of a spectral basis function, has three numbers. So any number of bands and channels goes through here.
//
// Layer k of prt_planes holds planes 4k to 4k + 3 in its red, green, blue and alpha, so that 25 planes are 7 lookups;
// planes that are not there have scales of 0.
layout(binding = 0) uniform sampler2DArray prt_planes;

layout(std430, binding = 0) readonly buffer PrtWeights {
  vec4 prt_constant;  // rgb
  vec4 prt_scales[];  // three per layer: what its four planes add to red, to green and to blue
};

// Linear RGB; may be below 0 where truncated harmonics ring.
vec3 prt_exit_radiance(vec2 uv) {
  vec3 radiance = prt_constant.rgb;
  for (int layer = 0; layer < prt_scales.length() / 3; ++layer) {
    vec4 stored = textureLod(prt_planes, vec3(uv, layer), 0.0);
    radiance += vec3(dot(prt_scales[3 * layer], stored), dot(prt_scales[3 * layer + 1], stored),
                     dot(prt_scales[3 * layer + 2], stored));
  }
  return radiance;
}
