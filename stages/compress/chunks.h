// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "base/function_ref.h"

namespace kiln {

/// Runs `body(first, count)` for chunks of a range of `size`, in parallel. The chunks do not depend on the number of
/// threads; neither do sums per chunk that are added in their order.
void for_each_chunk(std::size_t size, FunctionRef<void(std::size_t first, std::size_t count)> body);
inline constexpr std::size_t chunk_texels = 4096;

/// Returns the sum over chunks, in their order, of what `body(first, count)` returns.
double sum_of_chunks(std::size_t size, FunctionRef<double(std::size_t first, std::size_t count)> body);

}  // namespace kiln
