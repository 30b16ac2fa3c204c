// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "base/command_line.h"
#include "lights/light_settings.h"

namespace kiln {

/// The options of a command line that say which lights are on; what they are given goes into `settings`, whose defaults
/// they show, and `light_file`.
void add_light_options(CommandLine& command, LightSettings& settings, std::filesystem::path& light_file);

/// The lights after parsing: those of the file where there is one. Throws WrongUsage where lights were given both ways,
/// BadInput as read_light_file does.
LightSettings chosen_lights(const LightSettings& settings, const std::filesystem::path& light_file);

}  // namespace kiln
