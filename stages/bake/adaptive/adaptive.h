// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "bake/bake_reports.h"
#include "bake/scene/receiver_set.h"
#include "base/progress.h"
#include "sh/transfer.h"

namespace kiln {

/// Function that returns the direct transfer of some receivers (their indices, ascending).
using BakeSome = std::function<TransferVectors(std::span<const std::uint32_t> receivers)>;

/// Bakes the corners of squares of 8 x 8 texels, cuts squares whose corners disagree into four, down to single texels,
/// and interpolates within the others, as D3DX's ComputeDirectLightingSHAdaptive refines triangles whose vertices
/// differ. A square must lie within a chart: all its texels covered, where its corners' positions say they are. What is
/// compared and interpolated is the light that shadows take: the transfer of an open hemisphere about each texel's own
/// normal less its transfer, so that detail of normals stays; corners count by how far they face as the texel does, and
/// a texel that turns more than 45 degrees from one is baked.
///
/// After each round, up to 2,048 interpolated texels, evenly spread, are baked too. If their error says that
/// interpolation costs more than `target` (relative L2 over all texels), squares must agree better in the next round.
///
/// `known` is 1 where `transfer` already has a receiver's vector; all have one afterwards. The same bits for any number
/// of threads that `bake_some` gives the same bits for.
AdaptiveReport adaptive_transfer(const ReceiverSet& receivers, std::vector<std::uint8_t> known,
                                 const BakeSome& bake_some, double target, TransferVectors& transfer,
                                 const ProgressFunction& progress = no_progress);

}  // namespace kiln
