// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sh/transfer.h"

namespace kiln {

/// Multiplies each receiver's transfer by its albedo, linear red, green and blue, if there are any. One channel becomes
/// three where an albedo is not grey.
void multiply_albedo(std::vector<TransferVectors>& channels, std::span<const Eigen::Vector3f> albedos);

}  // namespace kiln
