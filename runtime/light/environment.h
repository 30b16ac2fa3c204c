// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "sh/lights.h"

namespace kiln {

/// Reads an environment into spherical harmonics of three channels. A file is a latitude-longitude picture of radiance
/// (EXR or Radiance HDR; the whole sphere, +Y up, directions as in latitude_longitude_light). A folder is a cube map:
/// its square pictures px, nx, py, ny, pz and nz (.exr or .hdr), first row at the top, are the faces, directions as in
/// cube_map_light. `rotation_degrees` turns the environment about +Y: light from azimuth a then comes from a +
/// rotation. Throws BadInput.
LightCoefficients load_environment(const std::filesystem::path& file, int bands, double rotation_degrees);

}  // namespace kiln
