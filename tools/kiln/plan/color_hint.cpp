// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/plan/color_hint.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>
#include <sstream>
#include <vector>

#include "bake/bake_settings.h"
#include "base/json.h"
#include "spectrum/rgb_lift.h"
#include "spectrum/spectral_error.h"
#include "spectrum/standards.h"
#include "spectrum/wavelengths.h"

namespace kiln {

namespace {

constexpr int fewest_wavelengths = 4, most_wavelengths = 8;  // of kiln-bake --spectrum, and as many as the report tries
constexpr int most_reflections = 4, reflections_of_auto = 4;
constexpr const char* stand_ins = "CIE-TCS";

std::vector<std::string> names_between_commas(const std::string& text) {
  std::vector<std::string> names;
  std::istringstream list(text);
  for (std::string name; std::getline(list, name, ',');) {
    std::erase(name, ' ');
    names.push_back(name);
  }
  return names;
}

BakeSettings bake_of(const Asset& asset) {
  const auto given = asset.settings.find("bake");
  return settings_from(given == asset.settings.end() ? StageSettings() : given->second, bake_options);
}

/// Surfaces of an asset and of what stands around it.
class Surfaces {
 public:
  explicit Surfaces(const Pipeline& pipeline) : pipeline_(pipeline) {}

  void add(const BakeSettings& bake, const StandardSpectra& standards, const RgbLift& lift) {
    const MaterialSettings& material = bake.material;
    for (const auto& [name, reflectance] : reflectances_of_materials(material.reflectance_of))
      add_measured(standards, reflectance);
    if (material.reflectance.empty() && !material.albedo && material.reflectance_of.empty())
      return add(standards, stand_ins);
    if (!material.reflectance_of.empty()) return;
    if (material.albedo) {
      const auto& [red, green, blue] = *material.albedo;
      const std::string name = fmt::format("albedo {:.3g},{:.3g},{:.3g}", red, green, blue);
      arguments.insert(stand_ins);
      if (names.insert(name).second && std::max({red, green, blue}) > 0)
        reflectances.push_back({name, lift.lift(Eigen::Vector3d(red, green, blue)).spectrum()});
      return;
    }
    add_measured(standards, material.reflectance);
  }

  std::vector<NamedSpectrum> reflectances;
  std::set<std::string> names;
  std::set<std::string> arguments;  ///< of kiln-spectrum

 private:
  void add_measured(const StandardSpectra& standards, const std::string& name) {
    add(standards, is_test_sample(name) ? name : (pipeline_.folder / name).string());
  }

  void add(const StandardSpectra& standards, const std::string& name) {
    arguments.insert(name == stand_ins || is_test_sample(name) ? stand_ins : name);
    if (!names.insert(name).second) return;
    std::vector<NamedSpectrum> found =
        name == stand_ins ? standards.reflectances(name) : std::vector{standards.reflectance(name)};
    for (NamedSpectrum& one : found)
      if ((one.values > 0).any()) reflectances.push_back(std::move(one));  // black is black in every light
  }

  const Pipeline& pipeline_;
};

}  // namespace

std::optional<ColorHint> color_hint(const Pipeline& pipeline, const Asset& asset, const ColorGoal& goal) {
  const BakeSettings bake = bake_of(asset);
  if (bake.subsurface.wanted() ||
      (!bake.bounces.any() && bake.material.reflectance.empty() && bake.material.reflectance_of.empty()))
    return std::nullopt;
  const StandardSpectra standards;
  const RgbLift lift(standards);
  Surfaces surfaces(pipeline);
  surfaces.add(bake, standards, lift);
  for (const Asset& other : pipeline.assets)
    if (bake.bounces.any() && other.name != asset.name && pipeline.places.contains(asset.name) &&
        pipeline.places.contains(other.name))
      surfaces.add(bake_of(other), standards, lift);
  SpectralScene scene{{}, std::move(surfaces.reflectances), standards.observer(Observer::cie_1931)};
  const std::vector<std::string> lamps = names_between_commas(goal.lights);
  for (const std::string& light : lamps) scene.lights.push_back(standards.light(light));
  if (scene.reflectances.empty()) return std::nullopt;

  ColorHint hint;
  hint.goal = {fmt::format("{}", fmt::join(lamps, ",")), goal.max_ciede2000};
  hint.reflectances = fmt::format("{}", fmt::join(surfaces.arguments, ","));
  hint.surfaces = fmt::format("{}", fmt::join(surfaces.names, " and "));
  if (bake.bounces.any())
    hint.reflections =
        bake.bounces.automatic ? reflections_of_auto : std::min(bake.bounces.count + 1, most_reflections);
  const std::vector<ReflectionChain> chains = reflection_chains(scene.reflectances.size(), hint.reflections);
  hint.of_rgb = rgb_errors(scene, lift, chains).worst;
  if (hint.of_rgb <= goal.max_ciede2000) {
    hint.least = 0;
    hint.of_least = hint.of_rgb;
    return hint;
  }
  for (int size = fewest_wavelengths; size <= most_wavelengths && !hint.least; ++size) {
    hint.of_least = wavelength_errors(scene, find_wavelengths(scene, size), chains).worst;
    if (hint.of_least <= goal.max_ciede2000) hint.least = size;
  }
  return hint;
}

std::string to_text(const ColorHint& hint) {
  const std::string wrong = fmt::format(
      "red, green and blue are wrong by {:.2g} CIEDE2000 at worst under {}, of {}{}", hint.of_rgb, hint.goal.lights,
      hint.surfaces,
      hint.reflections == 1 ? std::string(" in direct light") : fmt::format(" at {} reflections", hint.reflections));
  if (hint.least == 0) return "colour: " + wrong + ", which is enough";
  if (hint.reflections == 1)
    return "colour: " + wrong + "; the bake has no colour, and kiln-render --lamp draws a lamp's light in full";
  const int size = hint.least.value_or(most_wavelengths);
  return fmt::format(
      "colour: {}; {} wavelengths by {:.2g}{}: kiln-spectrum -o basis.json --lights {} --reflectances {} --size {}, "
      "and 'bake: "
      "{{spectrum: basis.json}}'",
      wrong, size, hint.of_least, hint.least ? "" : fmt::format(", more than {:.3g}", hint.goal.max_ciede2000),
      hint.goal.lights, hint.reflectances, size);
}

Json to_json(const ColorHint& hint) {
  return {{"lights", hint.goal.lights},
          {"max_ciede2000", hint.goal.max_ciede2000},
          {"surfaces", hint.surfaces},
          {"reflections", hint.reflections},
          {"rgb", hint.of_rgb},
          {"least", !hint.least ? Json() : *hint.least == 0 ? Json("rgb") : Json(*hint.least)},
          {"of_least", hint.of_least}};
}

}  // namespace kiln
