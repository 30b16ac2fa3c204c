// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "kiln/gate/gate.h"

namespace kiln {

/// Name of that file in a pipeline's output folder.
inline constexpr const char* junit_file = "junit.xml";

/// Writes the outcome as JUnit XML: a suite for each asset, with a case for each budget, and cases "builds" and, with a
/// baseline, "picture"; a case that fails says "was, now, limit". Faults of the whole are a suite of their own.
std::string junit_xml(const Gate& gate);

}  // namespace kiln
