// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "report/reference.h"
#include "sh/light_spec.h"

namespace kiln {

/// Lamp in which pictures show an asset of wavelengths.
struct PictureLamp {
  std::string name;   ///< as kiln-render --lamp takes it
  SpectralView view;  ///< what a monitor of sRGB's primaries shows of it, light of D65's colour being white
};

/// Returns the first lamp that an asset of wavelengths has a matrix for and whose spectrum is at hand: one of the
/// CIE's, a computed one, or a file. Throws BadInput where there is none, MachineLacks without the CIE's spectra.
PictureLamp picture_lamp(const PrtDescription& asset);

/// Throws WrongUsage, naming the option, for lights that have a colour: a lamp's spectrum is theirs.
void require_no_color(const std::string& option, const std::vector<LightSpec>& lights);

}  // namespace kiln
