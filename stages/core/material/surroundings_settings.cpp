// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/surroundings_settings.h"

#include "base/numbers.h"

namespace kiln {

namespace {

constexpr double farthest = 1e6;

void require_count(const char* name, const std::string& text, std::size_t least, std::size_t most) {
  const std::size_t count = parse_numbers(name, text, -farthest, farthest).size();
  if (count < least || count > most)
    throw WrongUsage(std::string(name) + ": found '" + text + "'; expected " + std::to_string(least) + " to " +
                     std::to_string(most) + " numbers between commas");
}

}  // namespace

void add_surroundings_options(OptionSet& options, Surroundings& surroundings) {
  options.checked_text(
      "place", surroundings.place, "X,Y,Z[,AZIMUTH[,SCALE]]",
      "Where the asset stands among its neighbours: units of the scene, degrees about +Y, and a factor",
      [](const std::string& text) { require_count("place", text, 3, 5); });
  options.checked_text(
      "ground", surroundings.ground, "none or HEIGHT[,HALF-SIZE]",
      "A square plane below the asset that casts shadows, in units of the scene; half its size is four "
      "diagonals of the asset's box where that is left out",
      [](const std::string& text) {
        if (text != "none") require_count("ground", text, 1, 2);
      });
}

}  // namespace kiln
