// SPDX-License-Identifier: GPL-3.0-or-later
#include "compress/chunks.h"

#include <algorithm>
#include <vector>

#include "base/parallel.h"

namespace kiln {

void for_each_chunk(std::size_t size, FunctionRef<void(std::size_t, std::size_t)> body) {
  const std::size_t chunks = (size + chunk_texels - 1) / chunk_texels;
  parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
    const std::size_t first = chunk * chunk_texels;
    body(first, std::min(chunk_texels, size - first));
  });
}

double sum_of_chunks(std::size_t size, FunctionRef<double(std::size_t, std::size_t)> body) {
  std::vector<double> sums((size + chunk_texels - 1) / chunk_texels, 0.0);
  for_each_chunk(size, [&](std::size_t first, std::size_t count) { sums[first / chunk_texels] = body(first, count); });
  double sum = 0;
  for (const double part : sums) sum += part;
  return sum;
}

}  // namespace kiln
