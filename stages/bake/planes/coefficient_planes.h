// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "asset/prt_asset.h"
#include "bake/scene/texel_receivers.h"
#include "base/outputs.h"
#include "detail/seam_choice.h"
#include "detail/seams.h"
#include "sh/transfer.h"

namespace kiln {

/// What came of writing planes. Mismatch is how far both sides of the seams are apart in what bilinear lookups of the
/// stored planes give: the distance between transfer vectors, of all channels together, over their root mean square
/// length over receivers.
struct WrittenPlanes {
  SeamMismatch before;            ///< of planes stored as they were baked
  SeamMismatch after;             ///< of those that were written
  double change = 0;              ///< relative L2, over receivers, of what equalising changed, before storing
  double quantisation_error = 0;  ///< relative L2, over receivers, of what storing changed, after equalising
};

/// Writes a picture for every channel and coefficient, gutters filled, seams treated as `choice` says, and ranges.json,
/// last. One entry of `channels` per channel, all for the same receivers, which are texels of the atlas of `seams`.
/// `asset` says what a consumer finds in the folder besides the planes (mesh, normals, albedo) and the bits of a stored
/// value. Planes that an earlier run with more of them left in the folder are removed.
WrittenPlanes write_planes(OutputSet& outputs, const std::vector<TransferVectors>& channels,
                           const TexelReceivers& receivers, PrtDescription asset, const Seams& seams,
                           SeamChoice choice);

}  // namespace kiln
