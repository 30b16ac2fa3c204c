// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "asset/prt_asset.h"
#include "bake/scene/receiver_set.h"
#include "base/outputs.h"
#include "maps/seam_choice.h"
#include "maps/seams.h"
#include "sh/transfer.h"

namespace kiln {

/// Result of writing planes. Mismatch is the distance between the transfer vectors that bilinear lookups give on both
/// sides of a seam, all channels together, over the root mean square length of receivers' vectors.
struct WrittenPlanes {
  SeamMismatch before;            ///< mismatch of planes stored as they were baked
  SeamMismatch after;             ///< mismatch of the planes that were written
  double change = 0;              ///< relative L2, over receivers, of equalising, before storing
  double quantisation_error = 0;  ///< relative L2, over receivers, of storing, after equalising
};

/// Writes a picture for every channel and coefficient, gutters filled, seams treated as `choice` says, and ranges.json,
/// last. One entry of `channels` per channel, all for the same receivers, which are texels of the atlas of `seams`.
/// `asset` says what a consumer finds in the folder besides the planes (mesh, normals, albedo) and the bits of a stored
/// value. Planes that an earlier run with more of them left in the folder are removed.
WrittenPlanes write_planes(OutputSet& outputs, const std::vector<TransferVectors>& channels,
                           const ReceiverSet& receivers, PrtDescription asset, const Seams& seams, SeamChoice choice);

}  // namespace kiln
