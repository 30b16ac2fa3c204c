// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "lights/light_settings.h"

namespace kiln {

class CommandLine;

/// Adds the options for lights to a command line; their values go to `settings`, whose defaults they show, and
/// `light_file`.
void add_light_options(CommandLine& command, LightSettings& settings, std::filesystem::path& light_file);

/// Returns the lights after parsing: those of the file if there is one. Throws WrongUsage if lights were given both
/// ways, BadInput as read_light_file does.
LightSettings chosen_lights(const LightSettings& settings, const std::filesystem::path& light_file);

}  // namespace kiln
