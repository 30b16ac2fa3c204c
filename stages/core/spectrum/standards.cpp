// SPDX-License-Identifier: GPL-3.0-or-later
// Lights after [CIE 15]: daylight by its components, and illuminants as tabulated in colord-data.

#include "spectrum/standards.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <optional>
#include <string_view>

#include "base/errors.h"
#include "base/numbers.h"
#include "spectrum/spectrum_file.h"
#include "spectrum/sun_position.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

std::string in_capitals(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

/// Returns the digits after a letter as a number.
std::optional<int> number_after(const std::string& name, char letter) {
  int number = 0;
  if (name.size() < 3 || name[0] != letter) return std::nullopt;
  const auto [end, fault] = std::from_chars(name.data() + 1, name.data() + name.size(), number);
  return fault == std::errc() && end == name.data() + name.size() ? std::optional(number) : std::nullopt;
}

SpectrumMatrix side_by_side(const std::vector<SampledSpectrum>& spectra) {
  SpectrumMatrix matrix(wavelength_count, static_cast<Eigen::Index>(spectra.size()));
  for (std::size_t k = 0; k < spectra.size(); ++k) matrix.col(static_cast<Eigen::Index>(k)) = resample(spectra[k]);
  return matrix;
}

void require_within(const std::string& name, int kelvin, int lowest, int highest) {
  if (kelvin < lowest || kelvin > highest)
    throw WrongUsage(fmt::format("{}: found {} K; expected {} to {} K", name, kelvin, lowest, highest));
}

}  // namespace

StandardSpectra::StandardSpectra(fs::path folder) : folder_(std::move(folder)) {
  for (const char* const file : {"cmf/CIE1931-2deg-XYZ.cmf", "cmf/CIE1964-10deg-XYZ.cmf", "illuminant/CIE-D65.sp",
                                 "ref/CIE-1986-daylight-SPD.cmf", "ref/CIE-TCS.sp"})
    if (std::error_code error; !fs::exists(folder_ / file, error))
      throw MachineLacks((folder_ / file).string() +
                         " is not there; the CIE's spectra are in the package colord-data: install it, or name the "
                         "folder that holds its files");
}

NamedSpectrum StandardSpectra::light(const std::string& name) const {
  const std::string capitals = in_capitals(name);
  Spectrum power;
  if (std::ranges::find(light_names(), capitals) != light_names().end())
    power = resample(read_spectrum(folder_ / "illuminant" / ("CIE-" + capitals + ".sp"), SpectrumKind::light));
  else if (const auto digits = number_after(capitals, 'D'); digits && capitals.size() <= 6) {
    const int kelvin = capitals.size() == 3 ? *digits * 100 : *digits;
    require_within(name, kelvin, 4000, 25000);
    // Nominal temperatures are those of the scale of 1948, whose c2 was 1.4380e-2.
    power = daylight(capitals.size() == 3 ? kelvin * 1.4388 / 1.4380 : kelvin);
  } else if (const auto kelvin = number_after(capitals, 'P')) {
    require_within(name, *kelvin, 500, 100000);
    power = black_body(*kelvin);
  } else if (is_sun_hour(name)) {
    power = sunlight(visible_sun(parse_sun_hour(name)).elevation_degrees);
  } else if (capitals.starts_with("SUN:")) {
    power = sunlight(parse_numbers("light sun", std::string_view(name).substr(4), 0, 90).front());
  } else if (std::error_code error; fs::is_regular_file(name, error)) {
    power = resample(read_spectrum(name, SpectrumKind::light));
  } else {
    throw WrongUsage("light: found '" + name +
                     "'; expected A to E or F1 to F12 of the CIE, D50 or D5600 for daylight, P2856 for a black body, "
                     "sun:20 for the sun, sun:2026-06-21T17:30+02:00@48.1,11.6 at an hour, or a file");
  }
  const double luminance = (power * observer(Observer::cie_1931).col(1).array()).sum();
  if (!(luminance > 0))
    throw BadInput(name, "sends out nothing that is seen", "power at 400 to 700 nm", "name another light");
  return {name, power / luminance};
}

std::vector<NamedSpectrum> StandardSpectra::reflectances(const std::string& name) const {
  fs::path file = name;
  if (in_capitals(name) == "CIE-TCS")
    file = folder_ / "ref/CIE-TCS.sp";
  else if (std::error_code error; !fs::is_regular_file(file, error))
    throw WrongUsage("reflectances: found '" + name + "'; expected CIE-TCS or a file of reflectances");
  std::vector<NamedSpectrum> reflectances;
  for (const SampledSpectrum& sampled : read_spectra(file, SpectrumKind::reflectance))
    reflectances.push_back(
        {sampled.name.empty() ? fmt::format("{} {}", file.stem().string(), reflectances.size() + 1) : sampled.name,
         resample(sampled)});
  return reflectances;
}

NamedSpectrum StandardSpectra::reflectance(const std::string& name) const {
  const std::string capitals = in_capitals(name);
  if (std::error_code error; !fs::is_regular_file(name, error) && capitals.starts_with("TCS"))
    for (NamedSpectrum& sample : reflectances("CIE-TCS"))
      if (sample.name == capitals) return sample;
  if (std::error_code error; !fs::is_regular_file(name, error) && capitals != "CIE-TCS")
    throw WrongUsage("reflectance: found '" + name +
                     "'; expected TCS01 to TCS15, a test colour sample of the CIE, or a file of a reflectance");
  std::vector<NamedSpectrum> found = reflectances(name);
  if (found.size() != 1)
    throw BadInput(name, fmt::format("holds {} reflectances", found.size()), "one",
                   "copy the one that is meant into a file of its own");
  return found.front();
}

SpectrumMatrix StandardSpectra::observer(Observer which) const {
  const fs::path file =
      folder_ / (which == Observer::cie_1931 ? "cmf/CIE1931-2deg-XYZ.cmf" : "cmf/CIE1964-10deg-XYZ.cmf");
  const std::vector<SampledSpectrum> functions = read_spectra(file, SpectrumKind::response);
  if (functions.size() != 3)
    throw BadInput(file.string(), fmt::format("holds {} functions", functions.size()), "x, y and z of an observer",
                   "install colord-data again");
  return side_by_side(functions);
}

Spectrum StandardSpectra::daylight(double kelvin) const {
  const fs::path file = folder_ / "ref/CIE-1986-daylight-SPD.cmf";
  const std::vector<SampledSpectrum> parts = read_spectra(file, SpectrumKind::component);
  if (parts.size() != 3)
    throw BadInput(file.string(), fmt::format("holds {} functions", parts.size()), "S0, S1 and S2 of daylight",
                   "install colord-data again");
  const double t = 1000 / kelvin;
  const double x = kelvin <= 7000 ? ((-4.6070 * t + 2.9678) * t + 0.09911) * t + 0.244063
                                  : ((-2.0064 * t + 1.9018) * t + 0.24748) * t + 0.237040;
  const double y = (-3.000 * x + 2.870) * x - 0.275;
  const double below = 0.0241 + 0.2562 * x - 0.7341 * y;
  const double m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / below;
  const double m2 = (0.0300 - 31.4424 * x + 30.0717 * y) / below;
  const SpectrumMatrix s = side_by_side(parts);
  const Spectrum power = s.col(0).array() + m1 * s.col(1).array() + m2 * s.col(2).array();
  return power.max(0) / power(560 - first_wavelength_nm);
}

Spectrum black_body(double kelvin) {
  const auto planck = [&](double nm) {
    const double metres = nm * 1e-9;
    return 1 / (std::pow(metres, 5) * std::expm1(1.4388e-2 / (metres * kelvin)));
  };
  Spectrum power(wavelength_count);
  for (int i = 0; i < wavelength_count; ++i) power(i) = planck(wavelength_nm(i)) / planck(560);
  return power;
}

Spectrum sunlight(double elevation_degrees) {
  // Relative mass of air on the way.
  const double air =
      1 / (std::sin(elevation_degrees * std::numbers::pi / 180) + 0.15 * std::pow(elevation_degrees + 3.885, -1.253));
  constexpr double turbidity = 2, haze = 0.04608 * turbidity - 0.04586;
  Spectrum power = black_body(5778);
  for (int i = 0; i < wavelength_count; ++i) {
    const double micrometres = wavelength_nm(i) / 1000;
    power(i) *= std::exp(-air * (0.008735 * std::pow(micrometres, -4.08) + haze * std::pow(micrometres, -1.3)));
  }
  return power;
}

const std::vector<std::string>& StandardSpectra::light_names() {
  static const std::vector<std::string> names = {"A",  "B",  "C",  "D50", "D55", "D65", "D93", "E",   "F1",  "F2",
                                                 "F3", "F4", "F5", "F6",  "F7",  "F8",  "F9",  "F10", "F11", "F12"};
  return names;
}

}  // namespace kiln
