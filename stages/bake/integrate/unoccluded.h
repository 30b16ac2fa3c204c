// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "sh/transfer.h"

namespace kiln {

/// Returns 1 for each receiver whose hemisphere is empty, so that its transfer is known without a test: no corner of
/// the occluders' convex hull rises above the receiver's tangent plane, lifted by `lift` (object units) along the
/// normal. Conservative: a receiver with something in its hemisphere gets 0; one with an empty hemisphere may get 0
/// within a few roundings. `hull_corners`: points whose convex hull holds all occluders; none leave every receiver
/// free.
std::vector<std::uint8_t> unoccluded_receivers(std::span<const Eigen::Vector3f> hull_corners,
                                               const Receivers& receivers, float lift);

}  // namespace kiln
