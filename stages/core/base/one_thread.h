// SPDX-License-Identifier: MIT
#pragma once

#include "base/function_ref.h"

namespace kiln {

/// Calls body() so that loops in it, of other libraries that use TBB too, see a machine of one thread: what they make
/// does not depend on the number of threads.
void on_one_thread(FunctionRef<void()> body);

}  // namespace kiln
