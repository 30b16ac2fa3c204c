// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "sh/lights.h"

namespace kiln {

/// A latitude-longitude picture of radiance (EXR or Radiance HDR; the whole sphere, +Y up, the direction of a pixel as
/// latitude_longitude_light has it) in spherical harmonics, three channels. `rotation_degrees` turns the environment
/// about +Y: what was at azimuth a comes to a + rotation. A folder is a cube map: square pictures px, nx, py, ny, pz
/// and nz (.exr or .hdr) in it are the faces, as cube_map_light has them, the first row at the top. Throws BadInput.
LightCoefficients load_environment(const std::filesystem::path& file, int bands, double rotation_degrees);

}  // namespace kiln
