// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "lights/light_settings.h"

namespace kiln {

/// Reads the lights of a scene from a JSON file: {"lights": ["45,30", "sphere:1,2,1,0.1"], ...}, whose other keys are
/// those of light_options and "environment", a path relative to the file. Throws BadInput if the file is not such an
/// object, has an unknown key, or a value that the option refuses.
LightSettings read_light_file(const std::filesystem::path& file);

}  // namespace kiln
