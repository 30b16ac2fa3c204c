// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "base/json_fwd.h"
#include "image/image.h"
#include "maps/seam_choice.h"
#include "maps/seams.h"
#include "material/surface_albedo.h"
#include "mesh/triangle_mesh.h"
#include "normals/map_error.h"

namespace kiln {

/// The high mesh's reflectance in the texels of an atlas.
struct AlbedoMap {
  Image<std::uint8_t> picture;  ///< content of albedo.png: 3 channels, sRGB-encoded, gutters filled
  SeamMismatch seam_before;     ///< before seams are equalised; linear, over all channels
  SeamMismatch seam_after;      ///< of the map as written
  AlbedoError error;            ///< of the map as written, over the high mesh

  Json to_json() const;
};

/// Makes the map that is written from `linear`, which has values where `known` is 1: fills gutters, equalises seams,
/// clamps to 0 .. 1 and encodes as sRGB. `covered` marks the texels inside charts. Does not measure errors.
AlbedoMap make_albedo_map(Image<float> linear, const std::vector<std::uint8_t>& known,
                          const std::vector<std::uint8_t>& covered, const Seams& seams, SeamChoice choice);

}  // namespace kiln
