// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <tbb/enumerable_thread_specific.h>

#include "base/parallel.h"
#include "base/progress.h"

namespace kiln {

/// Calls work(packet, worker) for every packet, on all threads; each thread has a worker of its own, made by
/// make_worker(). Reports progress on the calling thread. Returns the workers.
template <class MakeWorker, class Work>
auto for_each_packet(std::size_t packets, const ProgressFunction& progress, const MakeWorker& make_worker,
                     const Work& work) {
  constexpr std::size_t group_packets = 1024;  // between two reports of progress
  constexpr std::size_t grain_packets = 4;     // that a thread takes at a time
  tbb::enumerable_thread_specific<decltype(make_worker())> workers(make_worker);
  for (std::size_t first = 0; first < packets; first += group_packets) {
    const std::size_t last = std::min(first + group_packets, packets);
    parallel_ranges(first, last, grain_packets, [&](std::size_t begin, std::size_t end) {
      auto& worker = workers.local();
      for (std::size_t packet = begin; packet != end; ++packet) work(packet, worker);
    });
    progress(static_cast<double>(last) / static_cast<double>(packets));
  }
  return workers;
}

}  // namespace kiln
