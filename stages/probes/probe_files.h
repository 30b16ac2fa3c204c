#pragma once

#include <filesystem>
#include <vector>

#include "base/command_line.h"
#include "probes/probes_settings.h"
#include "probes/surface_light.h"

namespace kiln {

/// Loads meshes as one scene, with what they reflect where light is to bounce, and tells `command` of warnings and of
/// further files that were read. Throws BadInput, also for meshes that need a frame of their own (MeshFrame), and
/// WrongUsage where light is to bounce and an albedo is not known.
ProbeScene load_probe_scene(const std::vector<std::filesystem::path>& files, const ProbesSettings& settings,
                            CommandLine& command);

}  // namespace kiln
