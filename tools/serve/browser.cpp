// SPDX-License-Identifier: GPL-3.0-or-later
#include "serve/browser.h"

#include <array>
#include <spawn.h>
#include <unistd.h>

namespace kiln {

bool open_in_browser(const std::string& address) {
  std::string program = "xdg-open", argument = address;
  const std::array<char*, 3> arguments = {program.data(), argument.data(), nullptr};
  pid_t process = 0;
  return posix_spawnp(&process, program.c_str(), nullptr, nullptr, arguments.data(), environ) == 0;
}

}  // namespace kiln
