// SPDX-License-Identifier: GPL-3.0-or-later
#include "spectrum/spectrum_report.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/errors.h"
#include "base/json.h"
#include "spectrum/wavelengths.h"

namespace kiln {

namespace {

constexpr int fewest = 3, most_of_table = 8, most = 16;

std::vector<std::string> parts_between_commas(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

Json to_json(const ColorErrors& errors) {
  return {{"mean", errors.mean}, {"worst", errors.worst}, {"worst_at", errors.worst_at}};
}

Json to_json(const ComparedColors& compared) {
  Json json = {{"direct", to_json(compared.direct)}, {"reflected", to_json(compared.reflected)}};
  if (compared.size > 0) json["size"] = compared.size;
  return json;
}

Json least_json(const std::optional<int>& least) { return !least ? Json() : *least == 0 ? Json("rgb") : Json(*least); }

}  // namespace

SpectralScene spectral_scene(const StandardSpectra& standards, const SpectrumSettings& settings) {
  SpectralScene scene;
  for (const std::string& name : parts_between_commas(settings.lights)) scene.lights.push_back(standards.light(name));
  for (const std::string& name : parts_between_commas(settings.reflectances))
    for (NamedSpectrum& reflectance : standards.reflectances(name)) {
      if (!(reflectance.values > 0).any())
        throw BadInput(name, reflectance.name + " is 0 at all wavelengths", "a surface that reflects light",
                       "leave it out: black is black under every light");
      scene.reflectances.push_back(std::move(reflectance));
    }
  scene.observer = standards.observer(settings.observer);
  return scene;
}

SpectralBasis basis_of(const BasisFinder& finder, BasisKind kind, int size) {
  if (kind == BasisKind::lights) return finder.lights();
  if (kind == BasisKind::points) return finder.points(std::max(size, 2));
  return finder.characteristic(std::min(size, finder.rank()));
}

SpectrumReport compare_colors(const StandardSpectra& standards, const SpectralScene& scene, const BasisFinder& finder,
                              const SpectrumSettings& settings) {
  const std::vector<ReflectionChain> direct = reflection_chains(scene.reflectances.size(), 1);
  const std::vector<ReflectionChain> several = reflection_chains(scene.reflectances.size(), settings.reflections);
  const RgbLift lift(standards);
  SpectrumReport report;
  report.chains = several.size();
  report.rgb = {"RGB", 0, rgb_errors(scene, lift, direct), rgb_errors(scene, lift, several)};
  report.lifted = {"lifted", 0, lifted_errors(scene, lift, direct), lifted_errors(scene, lift, several)};
  if (report.rgb.direct.worst <= settings.error) report.least_direct = 0;
  if (report.rgb.reflected.worst <= settings.error) report.least_reflected = 0;

  for (int size = fewest; size <= most; ++size) {
    if (size > most_of_table && report.least_direct && report.least_reflected) break;
    const SpectralBasis basis = basis_of(finder, settings.basis, size);
    if (!report.bases.empty() && basis.size() == report.bases.back().size) break;  // the scene has no more
    report.bases.push_back(
        {basis.kind, basis.size(), basis_errors(scene, basis, direct), basis_errors(scene, basis, several)});
    const ComparedColors& compared = report.bases.back();
    if (!report.least_direct && compared.direct.worst <= settings.error) report.least_direct = compared.size;
    if (!report.least_reflected && compared.reflected.worst <= settings.error) report.least_reflected = compared.size;
  }
  for (int size = fewest; size <= most_of_table; ++size) {
    const WavelengthSet set = find_wavelengths(scene, size);
    report.wavelengths.push_back(
        {"wavelengths", size, wavelength_errors(scene, set, direct), wavelength_errors(scene, set, several)});
  }
  return report;
}

Json to_json(const SpectrumReport& report, const SpectralScene& scene) {
  Json lights = Json::array(), bases = Json::array(), wavelengths = Json::array();
  for (const NamedSpectrum& light : scene.lights) lights.push_back(light.name);
  for (const ComparedColors& basis : report.bases) bases.push_back(to_json(basis));
  for (const ComparedColors& set : report.wavelengths) wavelengths.push_back(to_json(set));
  return {{"lights", lights},
          {"surfaces", scene.reflectances.size()},
          {"chains", report.chains},
          {"step_nm", 1},
          {"rgb", to_json(report.rgb)},
          {"lifted", to_json(report.lifted)},
          {"bases", bases},
          {"wavelengths", wavelengths},
          {"least", {{"direct", least_json(report.least_direct)}, {"reflected", least_json(report.least_reflected)}}}};
}

std::string to_text(const SpectrumReport& report, const SpectralScene& scene, const SpectrumSettings& settings) {
  std::string text =
      fmt::format("CIEDE2000 to the truth in steps of 1 nm; {}{}, {}{}\n{:<24}{:>16}{:>16}   worst in direct light\n",
                  scene.lights.size(), scene.lights.size() == 1 ? " light" : " lights", scene.reflectances.size(),
                  scene.reflectances.size() == 1 ? " surface" : " surfaces", "", "direct",
                  fmt::format("{} reflections", settings.reflections));
  text += fmt::format("{:<24}{:>8}{:>8}{:>8}{:>8}\n", "", "mean", "worst", "mean", "worst");
  const auto add = [&](const std::string& name, const ComparedColors& compared) {
    text +=
        fmt::format("{:<24}{:>8.2f}{:>8.2f}{:>8.2f}{:>8.2f}   {}\n", name, compared.direct.mean, compared.direct.worst,
                    compared.reflected.mean, compared.reflected.worst, compared.direct.worst_at);
  };
  add("RGB", report.rgb);
  add("RGB lifted to spectra", report.lifted);
  for (const ComparedColors& basis : report.bases) add(fmt::format("{}, m = {}", basis.name, basis.size), basis);
  for (const ComparedColors& set : report.wavelengths) add(fmt::format("wavelengths, m = {}", set.size), set);
  const auto answer = [](const std::optional<int>& least) {
    return !least        ? std::string("more functions than were tried")
           : *least == 0 ? "RGB is enough"
                         : fmt::format("m = {}", *least);
  };
  return text + fmt::format("within {:.6g}: {} in direct light, {} at {} reflections\n", settings.error,
                            answer(report.least_direct), answer(report.least_reflected), settings.reflections);
}

}  // namespace kiln
