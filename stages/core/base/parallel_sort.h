// SPDX-License-Identifier: MIT
#pragma once

#include <tbb/parallel_sort.h>

namespace kiln {

/// Sorts by <, on all threads. Equal elements may change places, so give elements that differ an order.
template <class Iterator>
void parallel_sort(Iterator begin, Iterator end) {
  tbb::parallel_sort(begin, end);
}

}  // namespace kiln
