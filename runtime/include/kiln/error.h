// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>

#include "kiln/export.h"

namespace kiln::runtime {

/// Fault of a caller or a file, in one sentence: where, what was found, what was expected, the remedy.
class KILN_RUNTIME_API Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  ~Error() override;
};

}  // namespace kiln::runtime
