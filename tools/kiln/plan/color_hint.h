// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "base/json_fwd.h"
#include "kiln/pipeline.h"

namespace kiln {

/// Lamps that assets are to be seen in, and how wrong their colours may be.
struct ColorGoal {
  std::string lights = "D65";  ///< names of StandardSpectra::light between commas
  double max_ciede2000 = 1;    ///< at worst, beside each lamp's white
};

/// Whether red, green and blue are enough for an asset's lamps and surfaces, or how many wavelengths are.
struct ColorHint {
  ColorGoal goal;
  std::string surfaces;      ///< whose colours were compared
  std::string reflectances;  ///< the same as kiln-spectrum takes them: files, CIE-TCS for all others
  int reflections = 1;       ///< that were compared: those of the bake's bounces and the surface's own, 4 at most
  double of_rgb = 0;         ///< CIEDE2000 of red, green and blue at worst
  std::optional<int> least;  ///< wavelengths within the goal, 4 to 8; 0: red, green and blue are; nothing: none is
  double of_least = 0;       ///< CIEDE2000 of these wavelengths at worst, or of 8
};

/// Says so for an asset whose light bounces or whose surface was measured, nothing for others. What stands in its scene
/// counts, too. Surfaces of materials, textures or vertex colours of which none was measured are taken for the CIE's
/// test colour samples, and an albedo for what it is lifted to. Throws WrongUsage and BadInput for lights and
/// reflectances that are none, MachineLacks without the CIE's spectra.
std::optional<ColorHint> color_hint(const Pipeline& pipeline, const Asset& asset, const ColorGoal& goal);

/// Says it in one sentence, with what to do.
std::string to_text(const ColorHint& hint);

Json to_json(const ColorHint& hint);

}  // namespace kiln
