#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "image/image.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// One coefficient of one channel: stored values of 0 to 1 stand for `lowest` to `highest`.
struct PrtPlane {
  std::string file;
  int channel = 0;
  int coefficient = 0;
  double lowest = 0;
  double highest = 0;
};

/// A baked PRT folder, as it is on the disk: the mesh with its atlas, and a picture for every transfer coefficient.
/// Planes are sorted by channel, then coefficient; there is one for each.
struct PrtAsset {
  std::filesystem::path ranges_file;  ///< where it comes from, for messages
  TriangleMesh mesh;
  int bands = 0;
  int channels = 0;
  int bits = 8;  ///< 8 or 16: which of the two kinds of picture `pictures` holds
  int width = 0;
  int height = 0;
  std::vector<PrtPlane> planes;
  std::variant<std::vector<Image<std::uint8_t>>, std::vector<Image<std::uint16_t>>> pictures;
};

/// Reads `folder`/ranges.json and what it names: the mesh and the pictures, and nothing else. Throws BadInput where
/// anything is missing, damaged, or at odds with the rest.
PrtAsset load_prt_asset(const std::filesystem::path& folder);

}  // namespace kiln
