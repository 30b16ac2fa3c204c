// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

#include "base/errors.h"

namespace kiln {

/// Collects the faults that readers report: throws the first, or keeps all of them.
class Faults {
 public:
  enum class Mode { throw_first, keep_all };
  explicit Faults(Mode mode = Mode::throw_first) : mode_(mode) {}

  /// Throws `fault`, or keeps it.
  void tell(const BadInput& fault) {
    if (mode_ == Mode::throw_first) throw fault;
    found_.push_back(fault);
  }

  /// Runs `read` and reports the BadInput that it throws, if any. Returns whether it threw none.
  template <class Read>
  bool guard(Read&& read) {
    try {
      std::forward<Read>(read)();
      return true;
    } catch (const BadInput& fault) {
      tell(fault);
      return false;
    }
  }

  const std::vector<BadInput>& found() const { return found_; }

 private:
  Mode mode_;
  std::vector<BadInput> found_;
};

}  // namespace kiln
