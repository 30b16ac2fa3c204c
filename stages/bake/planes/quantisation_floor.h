// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "sh/transfer.h"

namespace kiln {

/// Returns the relative L2 that storing `transfer` costs: each plane's values are rounded to 2^bits - 1 steps of its
/// range, an error of variance step^2 / 12.
double quantisation_floor(const TransferVectors& transfer, int bits);

/// Returns the same over all channels together.
double quantisation_floor(std::span<const TransferVectors> channels, int bits);

}  // namespace kiln
