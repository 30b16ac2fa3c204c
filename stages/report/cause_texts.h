// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace kiln {

/// Words on a cause of the error.
struct CauseText {
  const char* name;    ///< key of `error.causes` in metrics.json
  const char* label;   ///< what it is, in a line of a table
  const char* phrase;  ///< the same after "of it are", without a number
  const char* remedy;  ///< settings that make it less
};

/// Returns the words on a cause; null for one that there are none on.
const CauseText* find_cause_text(const std::string& name);

}  // namespace kiln
