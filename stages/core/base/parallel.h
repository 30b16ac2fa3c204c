// SPDX-License-Identifier: MIT
#pragma once

// Every loop whose turns are shared among threads is one of these. All of them return when all turns are done. If a
// turn throws, turns that have not begun are left out, and the exception is thrown to the caller. TBB divides the work;
// this header leaves its headers out, so that those who include it compile fast.

#include <cstddef>
#include <memory>

#include "base/function_ref.h"

namespace kiln {

/// Calls body(first, last) for ranges that together are `begin` to `end`, the end not included. A range of more than
/// `grain` may be divided further; how far depends on the threads, so results must not depend on it.
void parallel_ranges(std::size_t begin, std::size_t end, std::size_t grain,
                     FunctionRef<void(std::size_t first, std::size_t last)> body);

/// Calls body(k) for every whole number k of `begin` to `end`, the end not included; none if `end` is not above
/// `begin`. `begin` is not negative. A thread takes about `grain` at a time or more.
template <class Index, class Body>
void parallel_for(Index begin, Index end, std::size_t grain, const Body& body) {
  if (!(begin < end)) return;
  parallel_ranges(static_cast<std::size_t>(begin), static_cast<std::size_t>(end), grain,
                  [&](std::size_t first, std::size_t last) {
                    for (std::size_t k = first; k < last; ++k) body(static_cast<Index>(k));
                  });
}

/// Calls body(k) for every whole number k of `begin` to `end` as above, for turns that take long.
template <class Index, class Body>
void parallel_for(Index begin, Index end, const Body& body) {
  parallel_for(begin, end, 1, body);
}

/// Calls both functions, at the same time if a thread is free.
void parallel_invoke(FunctionRef<void()> one, FunctionRef<void()> other);

/// Lets loops take at most so many threads, the calling one included, for as long as it lives.
class ThreadLimit {
 public:
  explicit ThreadLimit(std::size_t threads);

 private:
  std::shared_ptr<void> control_;
};

}  // namespace kiln
