// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <gtest/gtest.h>
#include <random>
#include <string>

#include "base/errors.h"

namespace kiln {

/// Flips, drops, doubles or cuts some bytes of a text.
inline std::string mutated(std::string text, std::mt19937& random) {
  const auto below = [&](std::size_t count) { return static_cast<std::size_t>(random()) % count; };
  for (std::size_t k = 1 + below(4); k > 0 && !text.empty(); --k) {
    const std::size_t at = below(text.size()), kind = below(6);
    if (kind == 0) text[at] = static_cast<char>(random());
    if (kind == 1) text.erase(at, 1 + below(8));
    if (kind == 2) text.insert(at, text.substr(below(text.size()), 1 + below(12)));
    if (kind == 3) text.resize(at);
    if (kind == 4) text[at] = " \t\n\r\\/#-\"09e.,"[below(15)];
    if (kind == 5) text[at] = static_cast<char>(text[at] ^ 1 << below(8));
  }
  return text;
}

/// Hands `rounds` damaged copies of a text to `read`, which must return or throw BadInput. Returns how many it refused.
inline int count_refused(const std::string& good, int rounds, const std::function<void(const std::string&)>& read) {
  std::mt19937 random(7);
  int refused = 0;
  for (int round = 0; round < rounds; ++round) {
    const std::string text = mutated(good, random);
    try {
      read(text);
    } catch (const BadInput&) {
      ++refused;
    } catch (const std::exception& other) {
      ADD_FAILURE() << other.what() << " of\n" << text;
    }
  }
  return refused;
}

}  // namespace kiln
