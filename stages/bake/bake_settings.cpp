// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/bake_settings.h"

#include <charconv>

#include "base/errors.h"
#include "base/number_text.h"

namespace kiln {

namespace {

/// Adds the options of light that bounces, and of what it bounces off.
void add_bounce_options(OptionSet& options, BakeSettings& settings) {
  add_bounces_option(
      options, settings.bounces,
      "How often light bounces off the occluders; auto: until the next bounce adds less than what --bits "
      "costs");
  options.affects(Affects::storing);
  OptionSet material, import;
  add_material_options(material, settings.material);
  add_import_options(import, settings.import);
  options.append(material, Affects::storing)
      .append(import, Affects::sums)
      .toggle("bake-albedo", settings.bake_albedo,
              "Puts the receivers' albedo in the stored transfer, in place of leaving it to the renderer")
      .affects(Affects::storing)
      .file("spectrum", settings.spectrum,
            "A basis file of kiln-spectrum: light bounces at its wavelengths, each a channel, in place of red, green "
            "and blue; kiln-render --lamp draws what its lamps show")
      .affects(Affects::storing)
      .number("bounce-edge", settings.bounce_edge, 1e-4, 1,
              "Light bounces off a surface whose longer edges are cut: the longest, a fraction of the occluders' "
              "diagonal")
      .affects(Affects::storing)
      .integer("bounce-memory", settings.bounce_memory, 0, 1'000'000,
               "MB that may be kept of rays for bounces to use again, half of it for the receivers and half for the "
               "surface; with less, more is searched again, and the result is the same")
      .affects(Affects::storing);
}

/// Adds the options of how the EGL engine decides visibility, which shadow_settings.h explains.
void add_shadow_options(OptionSet& options, BakeSettings& settings) {
  ShadowMapSettings& shadows = settings.shadows;
  options
      .integer_or_auto("shadow-size", settings.shadow_size, 16, 16384,
                       "Width and height of a depth map in texels; auto: the least of 256 to 4096 whose error, against "
                       "rays from some receivers, is under what --bits costs (egl)")
      .choice("shadow-depth", shadows.depth,
              {{"32f", ShadowDepth::float_32}, {"24", ShadowDepth::fixed_24}, {"16", ShadowDepth::fixed_16}},
              "Bits of a depth: floating-point or fixed-point (egl)")
      .choice("shadow-faces", shadows.faces,
              {{"front", ShadowFaces::front}, {"back", ShadowFaces::back}, {"midpoint", ShadowFaces::midpoint}},
              "Which surface of closed occluders a depth map holds: the first, the first back face, or halfway (egl)")
      .choice("shadow-filter", shadows.filter,
              {{"nearest", ShadowFilter::nearest},
               {"2x2", ShadowFilter::two_by_two},
               {"3x3", ShadowFilter::three_by_three}},
              "Depth comparisons per receiver and direction (egl)")
      .choice("shadow-compare", shadows.receiver_plane, {{"plane", true}, {"point", false}},
              "Depth that a texel is compared with: of the receiver's tangent plane there, or the receiver's own (egl)")
      .number_or_auto("shadow-bias", shadows.depth_bias, 0, 1,
                      "Constant depth bias as a fraction of the occluders' depth (egl); auto: as much as the precision "
                      "of their positions asks for")
      .number("shadow-angle-bias", shadows.angle_bias_texels, 0, 16,
              "Depth bias in depth map texels times the tangent of the angle between normal and direction (egl)")
      .number("normal-offset", shadows.normal_offset_texels, 0, 16,
              "How far receivers are moved along their normal, in depth map texels (egl)")
      .toggle(
          "shadow-ids", shadows.triangle_ids,
          "The triangle that a receiver stands on, and those that share a corner with it, cast no shadow on it (egl)")
      .toggle("shadow-regions", shadows.regions,
              "Do not test tiles of receivers that lie wholly in light or in shadow; changes no result (egl)")
      .choice("refine", shadows.refine, {{"none", false}, {"rays", true}},
              "Decide what a depth map cannot by rays: within its error band, and where texels do not agree (egl)")
      .number("shadow-band", shadows.error_band_texels, 0, 16,
              "Error band of a depth map in texels times the tangent as above (egl)")
      .toggle("count-ambiguous", shadows.count_ambiguous, "Count those even where rays do not decide them (egl)");
}

std::string error_text(const ErrorTarget& target) {
  return !target.wanted ? "none" : target.floor ? "auto" : numbers_text({target.error});
}

const std::vector<std::pair<std::string, BakeBackend>> backend_words = {{"auto", BakeBackend::automatic},
                                                                        {"egl", BakeBackend::egl},
                                                                        {"mixed", BakeBackend::mixed},
                                                                        {"beams", BakeBackend::beams},
                                                                        {"embree", BakeBackend::embree}};

}  // namespace

ErrorTarget parse_error_target(const std::string& text) {
  if (text == "none") return {};
  if (text == "auto") return {.wanted = true, .floor = true, .error = 0};
  double error = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), error);
  if (failure != std::errc{} || end != text.data() + text.size() || !(error > 0 && error < 1))
    throw WrongUsage("max-error: found '" + text + "'; expected none, auto or a number above 0 and below 1");
  return {.wanted = true, .floor = false, .error = error};
}

std::string backend_name(BakeBackend backend) {
  for (const auto& [name, value] : backend_words)
    if (value == backend) return name;
  return {};
}

namespace {

/// Adds the options of directions, engine, receivers, and storing.
void add_main_options(OptionSet& options, BakeSettings& settings) {
  options.integer("bands", settings.bands, 1, 24, "Bands of spherical harmonics; n bands have n*n coefficients")
      .affects(Affects::sums)
      .integer("directions", settings.directions, 1, 100'000'000, "Directions that the transfer is integrated over")
      .affects(Affects::plan)
      .choice("sampling", settings.sampling,
              {{"fibonacci", Sampling::fibonacci},
               {"progressive", Sampling::progressive},
               {"stratified", Sampling::stratified}},
              "How the directions are spread")
      .affects(Affects::sums)
      .typed<ErrorTarget>(
          "max-error", settings.max_error, "none, auto or a number above 0 and below 1",
          "Takes as many directions as bring the estimated error of integration under this: a relative L2 of transfer "
          "vectors, or auto for what --bits costs; the directions are then progressive ones",
          parse_error_target, error_text)
      .affects(Affects::plan)
      .integer("max-directions", settings.max_directions, 64, 100'000'000, "The most directions that --max-error takes")
      .affects(Affects::plan)
      .number("adaptive", settings.adaptive, 0, 0.5,
              "Bakes some texels and interpolates others where that costs no more than this, a relative L2 of transfer "
              "vectors as texels held out say; 0 bakes every texel")
      .affects(Affects::sums)
      .choice("backend", settings.backend, backend_words,
              "Shadows from depth maps on the GPU, from beams of rays on the CPU, or ray by ray from Embree, the "
              "reference; mixed: beams for texels for which a pilot finds them cheaper, else rays; auto: egl if EGL "
              "has a GPU, else mixed, but embree below 192 directions")
      .affects(Affects::plan)
      .choice(
          "receiver", settings.receiver, {{"high", BakeReceiver::high}, {"low", BakeReceiver::low}},
          "Which surface receives light: the high mesh's point of a texel (needs --detail) or of a vertex (the closest "
          "of the first --occluder), or the low mesh's")
      .affects(Affects::sums)
      .choice("shadows", settings.casts_shadows, {{"cast", true}, {"none", false}},
              "Whether occluders cast shadows; none: transfer of the normals alone, in closed form, as a convex asset "
              "that stands alone has it")
      .affects(Affects::sums)
      .toggle("per-vertex", settings.per_vertex, "Bake into the vertices of any mesh: no atlas, no --detail, no --size")
      .affects(Affects::sums)
      .integer("bits", settings.bits, 8, 16, "Bits of a stored coefficient, 8 or 16")
      .affects(Affects::storing)
      .typed<ShippedParts>(ship_setting, settings.ship, ship_range,
                           "What the folder holds beside transfer, which needs none of it: the normal map of --detail, "
                           "with bits of 8 or "
                           "16, or no normal map",
                           parse_shipped_parts, text_of)
      .affects(Affects::storing)
      .choice(
          "buried", settings.buried, {{"fill", BuriedChoice::fill}, {"keep", BuriedChoice::keep}},
          "Fills texels that stand inside another part of the occluders from those beside them, or bakes them, black "
          "as they are; subsurface always keeps them")
      .affects(Affects::sums)
      .choice("seams", settings.seams, {{"equalise", SeamChoice::equalise}, {"keep", SeamChoice::keep}},
              "Changes texels near the atlas' seams so that lookups on both sides agree, or keeps them")
      .affects(Affects::storing)
      .extent("size", settings.size, 0, 16384,
              "Width and height in texels where no --detail says it; 0 for what kiln-atlas packed for")
      .affects(Affects::plan)
      .text("gl-device", settings.gl_device, "EGL device: auto, software, or its number")
      .affects(Affects::plan);
}

}  // namespace

void check_shadows(const BakeSettings& settings) {
  if (settings.casts_shadows) return;
  const auto refuse = [](bool given, const std::string& setting) {
    if (given) throw WrongUsage("shadows: found none beside " + setting + "; expected cast, or no " + setting);
  };
  refuse(settings.bounces.any(), "bounces");
  refuse(settings.subsurface.wanted(), "subsurface");
  refuse(settings.adaptive > 0, "adaptive");
  refuse(settings.max_error.wanted, "max-error");
}

OptionSet bake_options(BakeSettings& settings) {
  OptionSet options, surroundings, subsurface, shadows;
  add_main_options(options, settings);
  add_surroundings_options(surroundings, settings.surroundings);
  options.append(surroundings, Affects::sums);
  add_bounce_options(options, settings);
  add_subsurface_options(subsurface, settings.subsurface);
  add_shadow_options(shadows, settings);
  options.append(subsurface, Affects::storing)
      .append(shadows, Affects::sums)
      .number_or_auto(
          "ray-offset", settings.ray_offset, 0, 1,
          "Start of a ray off the surface as a fraction of the occluders' diagonal (rays); auto: as much as "
          "the precision of their positions asks for")
      .affects(Affects::sums)
      .integer("verify-directions", settings.verify_directions, 0, 100'000'000,
               "Also measure the error against that many rays per texel, and against the other backend; 0 for no")
      .affects(Affects::verifying)
      .integer("verify-texels", settings.verify_texels, 1, 100'000'000,
               "Texels, evenly spread, that the error is measured on")
      .affects(Affects::verifying);
  return options;
}

}  // namespace kiln
