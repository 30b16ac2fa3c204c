// SPDX-License-Identifier: GPL-3.0-or-later
#include "scatter/subsurface_settings.h"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include "base/errors.h"
#include "base/number_text.h"
#include "base/numbers.h"
#include "scatter/materials.h"

namespace kiln {

namespace {

using Colors = std::array<double, 3>;

struct NumberText {
  const char* name;
  const char* range;
  double lowest, highest;

  Colors parse(const std::string& text) const {
    const std::optional<Colors> colors = color_within(text, lowest, highest);
    if (!colors)
      throw WrongUsage(std::string(name) + ": found '" + text + "'; expected one number or R,G,B, each " + range);
    return *colors;
  }
};

constexpr NumberText scattering_text{"subsurface-scattering", "0 to 1e6 per mm", 0, 1e6};
constexpr NumberText absorption_text{"subsurface-absorption", "0 to 1e6 per mm", 0, 1e6};
constexpr NumberText albedo_text{"subsurface-albedo", "0 to 1", 0, 1};
constexpr NumberText path_text{"subsurface-mean-free-path", "1e-6 to 1e6 mm", 1e-6, 1e6};

std::string text_of(const GivenColors& given) {
  if (!given) return "";
  const auto [red, green, blue] = *given;
  return red == green && green == blue ? numbers_text({red}) : numbers_text({red, green, blue});
}

void add_text(OptionSet& options, const NumberText& text, GivenColors& value, const std::string& help) {
  options.typed<GivenColors>(
      text.name, value, std::string("one number or R,G,B, each ") + text.range, help,
      [text](const std::string& given) { return text.parse(given); }, text_of);
}

/// Throws WrongUsage for options that do not go with `material` and `model`.
void refuse_unused(const SubsurfaceSettings& settings, bool custom_dipole, bool custom_diffusion) {
  const auto refuse = [&](const char* name, bool given, bool used, const char* user) {
    if (given && !used)
      throw WrongUsage(std::string(name) + ": found with --subsurface " + settings.material +
                       " and --subsurface-model " +
                       (settings.model == SubsurfaceModel::dipole ? "dipole" : "diffusion") +
                       "; expected --subsurface custom and --subsurface-model " + user + ", or none of it");
  };
  refuse(scattering_text.name, settings.scattering.has_value(), custom_dipole, "dipole");
  refuse(absorption_text.name, settings.absorption.has_value(), custom_dipole, "dipole");
  refuse("subsurface-eta", settings.eta != SubsurfaceSettings().eta, custom_dipole, "dipole");
  refuse(albedo_text.name, settings.albedo.has_value(), custom_diffusion, "diffusion");
  refuse(path_text.name, settings.mean_free_path.has_value(), custom_diffusion, "diffusion");
}

Colors required(const NumberText& text, const GivenColors& value) {
  if (!value)
    throw WrongUsage(std::string("subsurface custom: found no --") + text.name +
                     "; expected one number or R,G,B, each " + text.range);
  return *value;
}

}  // namespace

void add_subsurface_options(OptionSet& options, SubsurfaceSettings& settings) {
  std::vector<std::pair<std::string, std::string>> words = {{"none", "none"}, {"custom", "custom"}};
  for (const ScatterMaterial& material : measured_materials()) words.emplace_back(material.name, material.name);
  options
      .choice("subsurface", settings.material, words,
              "Light goes through the material: as measured by Jensen et al. (2001), or of coefficients given; the "
              "surface's own albedo is then in the coefficients")
      .choice("subsurface-model", settings.model,
              {{"dipole", SubsurfaceModel::dipole}, {"diffusion", SubsurfaceModel::diffusion}},
              "How it spreads: the dipole of Jensen et al., or normalised diffusion (Christensen and Burley, 2015)");
  add_text(options, scattering_text, settings.scattering, "Reduced scattering coefficient (custom dipole)");
  add_text(options, absorption_text, settings.absorption, "Absorption coefficient (custom dipole)");
  options.number("subsurface-eta", settings.eta, 1, 3, "Index of refraction (custom dipole)");
  add_text(options, albedo_text, settings.albedo, "Share of light that leaves again (custom diffusion)");
  add_text(options, path_text, settings.mean_free_path, "Mean free path (custom diffusion)");
  options.number("subsurface-scale", settings.mm_per_unit, 1e-6, 1e9, "Millimetres to one unit of the mesh")
      .number("subsurface-solid-angle", settings.solid_angle, 0, 1,
              "Surface is taken together where it fills no more steradians seen from a point: the error of the "
              "hierarchy; 0 for every texel on its own");
}

std::vector<ScatterProfile> subsurface_profiles(const SubsurfaceSettings& settings) {
  const bool custom = settings.material == "custom", dipole = settings.model == SubsurfaceModel::dipole;
  refuse_unused(settings, custom && dipole, custom && !dipole);
  if (!settings.wanted()) return {};

  std::vector<ScatterProfile> profiles;
  if (custom && !dipole) {
    const Colors albedo = required(albedo_text, settings.albedo), path = required(path_text, settings.mean_free_path);
    for (std::size_t c = 0; c < 3; ++c) profiles.push_back(ScatterProfile::diffusion(albedo[c], path[c]));
  } else {
    ScatterMaterial material;
    if (custom) {
      material = {"custom", required(scattering_text, settings.scattering),
                  required(absorption_text, settings.absorption), settings.eta};
    } else {
      const auto table = measured_materials();
      material = *std::find_if(table.begin(), table.end(),
                               [&](const ScatterMaterial& candidate) { return candidate.name == settings.material; });
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const double scattering = material.scattering_per_mm[c], absorption = material.absorption_per_mm[c];
      if (scattering + absorption == 0)
        throw WrongUsage("subsurface custom: found scattering and absorption that are both 0; expected one above 0");
      const ScatterProfile half_space = ScatterProfile::dipole(scattering, absorption, material.eta);
      profiles.push_back(dipole ? half_space
                                : ScatterProfile::diffusion(half_space.total(), 1 / (scattering + absorption)));
    }
  }
  if (profiles[0] == profiles[1] && profiles[1] == profiles[2]) profiles.resize(1, profiles[0]);
  return profiles;
}

}  // namespace kiln
