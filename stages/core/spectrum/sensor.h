// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "spectrum/spectrum.h"
#include "spectrum/standards.h"

namespace kiln {

/// What reads light: a response curve per channel. A channel's value is the sum of light times its curve.
struct LightSensor {
  std::string name = {};
  std::vector<std::string> channels = {};
  SpectrumMatrix responses = {};  ///< a column per channel
};

/// Returns an observer as it sees a monitor of sRGB's primaries: channels red, green and blue, linear; light of D65's
/// colour with Y = 1 reads 1, 1, 1.
LightSensor monitor_sensor(const StandardSpectra& standards, Observer observer = Observer::cie_1931);

/// Reads a sensor, such as a camera, from a file of response curves (read_spectra); channels have the names of its
/// columns. Throws BadInput.
LightSensor sensor_of_file(const std::filesystem::path& file);

/// Scales each channel so that a perfect white under `light` reads 1, as a camera's white balance does. Throws BadInput
/// where a channel does not see the light.
LightSensor white_balanced(LightSensor sensor, const NamedSpectrum& light);

}  // namespace kiln
