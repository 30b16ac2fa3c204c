#pragma once

#include <cstdint>
#include <vector>

#include "base/options.h"
#include "detail/seam_choice.h"
#include "detail/seams.h"
#include "image/image.h"
#include "material/surface_albedo.h"
#include "mesh/triangle_mesh.h"
#include "normals/map_error.h"

namespace kiln {

/// The high mesh's reflectance in the texels of an atlas.
struct AlbedoMap {
  Image<std::uint8_t> picture;  ///< as albedo.png holds it: 3 channels, sRGB-encoded, gutters filled
  SeamMismatch seam_before;     ///< linear, over all channels; as kept
  SeamMismatch seam_after;      ///< of what is written
  AlbedoError error;            ///< over the high mesh, of what is written

  Json to_json() const;
};

/// From `linear`, which has values where `known` is 1, makes what is written: gutters filled, seams equal on both
/// sides, values within 0 to 1, sRGB-encoded. `covered` are the texels inside charts. Errors are not measured yet.
AlbedoMap make_albedo_map(Image<float> linear, const std::vector<std::uint8_t>& known,
                          const std::vector<std::uint8_t>& covered, const Seams& seams, SeamChoice choice);

}  // namespace kiln
