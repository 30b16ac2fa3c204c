// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/bounce_settings.h"

#include <charconv>

#include "base/errors.h"

namespace kiln {

BounceTarget parse_bounces(const std::string& text) {
  if (text == "auto") return {.automatic = true};
  int count = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (failure != std::errc{} || end != text.data() + text.size() || count < 0 || count > most_bounces)
    throw WrongUsage("bounces: found '" + text + "'; expected auto or a number of 0 to " +
                     std::to_string(most_bounces));
  return {.count = count};
}

OptionSet& add_bounces_option(OptionSet& options, BounceTarget& bounces, const std::string& help) {
  return options.typed<BounceTarget>(
      "bounces", bounces, "auto or 0 to " + std::to_string(most_bounces), help, parse_bounces,
      [](const BounceTarget& target) { return target.automatic ? "auto" : std::to_string(target.count); });
}

}  // namespace kiln
