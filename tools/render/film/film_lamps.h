// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "render/film/film.h"
#include "render/lamps.h"
#include "render/render_settings.h"

namespace kiln {

/// Lights a scene by spectra where its lights have lamps (`lamp`), or the settings have one for all of them, in place
/// of these: fills `film.lamps`. Files of lamps are relative to the scene's folder, and go before names. Reflectances
/// are of the assets in the order in which the scene first names them. Throws WrongUsage for settings that a scene does
/// not take, BadInput with the scene's line for lights and assets that cannot be lit so, MachineLacks without the
/// standards.
void light_by_lamps(Film& film, const std::filesystem::path& scene_file, const LampSettings& settings,
                    const RenderSettings& look);

}  // namespace kiln
