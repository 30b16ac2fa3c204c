// SPDX-License-Identifier: MIT
#include "base/interruption.h"

#include <csignal>

#include "base/errors.h"

namespace kiln {

namespace {

// The one mutable global of the tree: a signal handler can reach nothing else.
volatile std::sig_atomic_t g_noted_signal = 0;

}  // namespace

void stop_on_signals() {
  struct sigaction action = {};
  action.sa_handler = [](int number) { g_noted_signal = number; };
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

int noted_signal() { return g_noted_signal; }

void throw_if_interrupted() {
  if (g_noted_signal != 0) throw Interrupted();
}

}  // namespace kiln
