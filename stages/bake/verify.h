// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bake/bake.h"
#include "sh/transfer.h"

namespace kiln {

/// Distance of a baked asset from the truth.
struct BakeVerification {
  std::string other_backend;
  std::size_t backend_texels = 0;   ///< texels that both backends baked, spread evenly
  SampledError backend_difference;  ///< relative L2 to the other backend over the same directions, before quantisation
  int reference_directions = 0;
  std::size_t reference_texels = 0;
  SampledError integration_error;  ///< relative L2 to that many rays, before quantisation
  // Errors of the planes read back; none after subsurface scattering, which rays do not measure.
  std::optional<SampledError> error;             ///< relative L2 to that many rays
  std::optional<SampledError> relighting_error;  ///< the same as expected relighting error
};

/// Texels on which two backends are compared. A defect that misses all of them has, with a confidence of 95 %, less
/// than 3 in 16,384 of the texels: 1.4 % in relative L2 where it is as large as the transfer itself.
inline constexpr std::size_t compared_texels = 16384;

/// Compares `result`, which `job` gave, with the other backend (embree, or egl if embree baked it), and it and the
/// planes read back (`stored`) with settings.verify_directions rays from settings.verify_texels of the texels.
BakeVerification verify(const BakeResult& result, const std::vector<TransferVectors>& stored, const BakeJob& job);

}  // namespace kiln
