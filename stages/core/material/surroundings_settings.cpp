// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/surroundings_settings.h"

#include "base/errors.h"
#include "base/number_text.h"
#include "base/numbers.h"

namespace kiln {

namespace {

constexpr double farthest = 1e6;
constexpr const char* place_range = "X,Y,Z[,AZIMUTH[,SCALE]], a scale above 0";
constexpr const char* ground_range = "none or HEIGHT[,HALF-SIZE], a size above 0";

std::string place_text(const ScenePlace& place) {
  const auto [x, y, z] = place.position;
  if (place.scale != 1) return numbers_text({x, y, z, place.azimuth_degrees, place.scale});
  return place.azimuth_degrees != 0 ? numbers_text({x, y, z, place.azimuth_degrees}) : numbers_text({x, y, z});
}

std::string ground_text(const std::optional<GroundPlane>& ground) {
  if (!ground) return "none";
  return ground->half_size ? numbers_text({ground->height, *ground->half_size}) : numbers_text({ground->height});
}

}  // namespace

ScenePlace parse_scene_place(const std::string& text) {
  const std::vector<double> numbers = parse_numbers("place", text, -farthest, farthest);
  if (numbers.size() < 3 || numbers.size() > 5 || (numbers.size() > 4 && !(numbers[4] > 0)))
    throw WrongUsage("place: found '" + text + "'; expected " + place_range);
  ScenePlace place{.position = {numbers[0], numbers[1], numbers[2]}};
  if (numbers.size() > 3) place.azimuth_degrees = numbers[3];
  if (numbers.size() > 4) place.scale = numbers[4];
  return place;
}

std::optional<GroundPlane> parse_ground(const std::string& text) {
  if (text == "none") return std::nullopt;
  const std::vector<double> numbers = parse_numbers("ground", text, -farthest, farthest);
  if (numbers.size() > 2 || (numbers.size() > 1 && !(numbers[1] > 0)))
    throw WrongUsage("ground: found '" + text + "'; expected " + ground_range);
  GroundPlane ground{.height = numbers[0]};
  if (numbers.size() > 1) ground.half_size = numbers[1];
  return ground;
}

void add_surroundings_options(OptionSet& options, Surroundings& surroundings) {
  options.typed<ScenePlace>(
      "place", surroundings.place, place_range,
      "Where the asset stands among its neighbours: units of the scene, degrees about +Y, and a factor",
      parse_scene_place, place_text);
  options.typed<std::optional<GroundPlane>>(
      "ground", surroundings.ground, ground_range,
      "A square plane below the asset that casts shadows, in units of the scene; half its size is four "
      "diagonals of the asset's box where that is left out",
      parse_ground, ground_text);
}

}  // namespace kiln
