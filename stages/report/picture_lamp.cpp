// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/picture_lamp.h"

#include <array>

#include "base/errors.h"
#include "spectrum/rgb_lift.h"
#include "spectrum/standards.h"

namespace kiln {

namespace {

/// Tells whether kiln-render would find the spectrum of a lamp.
bool is_at_hand(const StandardSpectra& standards, const std::string& lamp) {
  try {
    standards.light(lamp);
    return true;
  } catch (const WrongUsage&) {
    return false;
  } catch (const BadInput&) {
    return false;
  }
}

}  // namespace

PictureLamp picture_lamp(const PrtDescription& asset) {
  const StandardSpectra standards;
  std::string names;
  for (const PrtSpectrum::Lamp& lamp : asset.spectrum->lamps) {
    names += (names.empty() ? "" : ", ") + lamp.name;
    if (!is_at_hand(standards, lamp.name)) continue;
    const auto count = static_cast<Eigen::Index>(asset.spectrum->wavelengths_nm.size());
    Eigen::Matrix3Xd xyz(3, count);
    for (Eigen::Index row = 0; row < 3; ++row)
      xyz.row(row) = Eigen::RowVectorXd::Map(lamp.xyz_from_channels[static_cast<std::size_t>(row)].data(), count);
    return {lamp.name,
            {asset.spectrum->wavelengths_nm, (RgbLift(standards).rgb_from_xyz() * xyz).eval().cast<float>()}};
  }
  throw BadInput(asset.ranges_file.string(), "has matrices for " + names + ", whose spectra are not at hand",
                 "at least one lamp of the CIE by name, or a file that is still there, to draw the pictures in",
                 "make the basis with one more of kiln-spectrum's --lights, such as D65, and bake again");
}

void require_no_color(const std::string& option, const std::vector<LightSpec>& lights) {
  const auto is_grey = [](const std::array<float, 3>& c) { return c[0] == c[1] && c[1] == c[2]; };
  for (const LightSpec& light : lights)
    if (!is_grey(light.color) || !is_grey(light.ground))
      throw WrongUsage(option + ": found the colour of the light " + to_text(light) +
                       "; expected one radiance, since transfer is at wavelengths and a lamp's spectrum is its colour");
}

}  // namespace kiln
