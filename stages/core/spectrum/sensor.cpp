// SPDX-License-Identifier: GPL-3.0-or-later
#include "spectrum/sensor.h"

#include <fmt/format.h>

#include "base/errors.h"
#include "spectrum/colorimetry.h"
#include "spectrum/spectrum_file.h"

namespace kiln {

LightSensor monitor_sensor(const StandardSpectra& standards, Observer observer) {
  const SpectrumMatrix functions = standards.observer(observer);
  const Xyz white = xyz_of(standards.light("D65").values, functions);
  return {observer == Observer::cie_1931 ? "CIE 1931" : "CIE 1964",
          {"red", "green", "blue"},
          functions * srgb_from_xyz(white / white.y()).transpose()};
}

LightSensor sensor_of_file(const std::filesystem::path& file) {
  LightSensor sensor{file.stem().string(), {}, {}};
  const std::vector<SampledSpectrum> curves = read_spectra(file, SpectrumKind::response);
  sensor.responses.resize(wavelength_count, static_cast<Eigen::Index>(curves.size()));
  for (const SampledSpectrum& curve : curves) {
    sensor.responses.col(static_cast<Eigen::Index>(sensor.channels.size())) = resample(curve);
    sensor.channels.push_back(curve.name.empty() ? fmt::format("channel {}", sensor.channels.size() + 1) : curve.name);
  }
  return sensor;
}

LightSensor white_balanced(LightSensor sensor, const NamedSpectrum& light) {
  for (Eigen::Index k = 0; k < sensor.responses.cols(); ++k) {
    const double white = sensor.responses.col(k).dot(light.values.matrix());
    if (!(white > 0))
      throw BadInput(sensor.name, sensor.channels[static_cast<std::size_t>(k)] + " does not see " + light.name,
                     "channels that do", "balance for another light");
    sensor.responses.col(k) /= white;
  }
  return sensor;
}

}  // namespace kiln
