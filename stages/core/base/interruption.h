// SPDX-License-Identifier: MIT
#pragma once

namespace kiln {

/// Makes SIGINT and SIGTERM be noted instead of ending the process; see throw_if_interrupted.
void stop_on_signals();

/// Throws Interrupted if a signal was noted.
void throw_if_interrupted();

/// Returns the signal that was noted, 0 for none.
int noted_signal();

}  // namespace kiln
