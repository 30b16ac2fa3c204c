#include "bake/bake_settings.h"

namespace kiln {

OptionSet bake_options(BakeSettings& settings) {
  OptionSet options;
  options.integer("bands", settings.bands, 1, 24, "Bands of spherical harmonics; n bands have n*n coefficients")
      .integer("directions", settings.directions, 1, 100'000'000, "Directions that the transfer is integrated over")
      .choice("sampling", settings.sampling,
              {{"fibonacci", Sampling::fibonacci},
               {"progressive", Sampling::progressive},
               {"stratified", Sampling::stratified}},
              "How the directions are spread")
      .text(
          "max-error", settings.max_error,
          "Takes as many directions as bring the estimated error of integration under this: a relative L2 of transfer "
          "vectors, or auto for what --bits costs; the directions are then progressive ones")
      .integer("max-directions", settings.max_directions, 64, 100'000'000, "The most directions that --max-error takes")
      .choice("backend", settings.backend,
              {{"auto", BakeBackend::automatic}, {"egl", BakeBackend::egl}, {"embree", BakeBackend::embree}},
              "Shadows from depth maps on the GPU, or from rays on the CPU; auto: the GPU if EGL has one")
      .choice(
          "receiver", settings.receiver, {{"high", BakeReceiver::high}, {"low", BakeReceiver::low}},
          "Which surface receives light: the high mesh's point of a texel (needs --detail) or of a vertex (the closest "
          "of the first --occluder), or the low mesh's")
      .toggle("per-vertex", settings.per_vertex, "Bake into the vertices of any mesh: no atlas, no --detail, no --size")
      .integer("bits", settings.bits, 8, 16, "Bits of a stored coefficient, 8 or 16")
      .integer("size", settings.size, 0, 16384,
               "Width and height in texels where no --detail says it; 0 for what kiln-atlas packed for")
      .text("gl-device", settings.gl_device, "EGL device: auto, software, or its number")
      .integer("shadow-size", settings.shadow_size, 16, 16384, "Width and height of a depth map in texels (egl)")
      .number("shadow-bias", settings.shadow_bias, 0, 1,
              "Constant depth bias as a fraction of the occluders' depth (egl)")
      .number("normal-offset", settings.normal_offset, 0, 16,
              "How far receivers are moved along their normal, in depth map texels (egl)")
      .choice("shadow-filter", settings.shadow_filter,
              {{"nearest", BakeShadowFilter::nearest}, {"2x2", BakeShadowFilter::two_by_two}},
              "Depth comparisons per receiver and direction (egl)")
      .number("ray-offset", settings.ray_offset, 0, 1,
              "Start of a ray off the surface as a fraction of the occluders' diagonal (embree)")
      .integer("verify-directions", settings.verify_directions, 0, 100'000'000,
               "Also measure the error against that many rays per texel, and against the other backend; 0 for no")
      .integer("verify-texels", settings.verify_texels, 1, 100'000'000,
               "Texels, evenly spread, that the error is measured on");
  return options;
}

}  // namespace kiln
