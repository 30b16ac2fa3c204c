// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace kiln {

/// Opens an address in the user's browser, by xdg-open, and does not wait for it. Returns whether that could be
/// started.
bool open_in_browser(const std::string& address);

}  // namespace kiln
