// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/state/keys.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace kiln {

namespace {

/// Data that a key may look at and change.
struct Press {
  ViewState& state;
  const ViewLimits& limits;
  const ViewState& home;
  char key;
};

/// One row of the table behind pressing, the help on the screen and --help.
struct Binding {
  std::string keys;  ///< each character is a key
  std::string shown;
  std::string does;
  std::function<KeyResult(const Press&)> act;
};

/// Returns the next of `count` choices, or with a negative step the previous one.
template <class Choice>
Choice step(Choice choice, int by, int count) {
  return static_cast<Choice>((static_cast<int>(choice) + by + count) % count);
}

KeyResult choose_technique(const Press& press) {
  const Technique wanted = all_techniques[static_cast<std::size_t>(press.key - '1')];
  if (!press.limits.allows(wanted))
    return {Wish::none, technique_name(wanted) + (wanted == Technique::compressed
                                                      ? ": the folder has no compressed form (kiln-compress)"
                                                      : ": the asset lacks what this draws by")};
  press.state.technique = wanted;
  return {};
}

/// Shows `show`, or the picture again if `show` is shown already.
KeyResult toggle_show(const Press& press, Show show) {
  press.state.show = press.state.show == show ? Show::picture : show;
  return {};
}

KeyResult step_coefficient(const Press& press, int by) {
  ViewState& state = press.state;
  if (state.show == Show::coefficient)
    state.coefficient = (state.coefficient + by + press.limits.coefficients()) % press.limits.coefficients();
  state.show = Show::coefficient;
  return {};
}

KeyResult toggle_difference(const Press& press) {
  if (!press.limits.has_reference)
    return {Wish::none, "difference: there is no plain PRT to compare with; open the asset's folder with prt/ in it"};
  return toggle_show(press, Show::difference);
}

KeyResult toggle_charts(const Press& press) {
  if (!press.limits.has_charts) return {Wish::none, "charts: an asset that is baked per vertex has none"};
  return toggle_show(press, Show::charts);
}

KeyResult toggle_environment(const Press& press) {
  if (!press.limits.has_environment) return {Wish::none, "environment: none was given; see --environment"};
  press.state.light.environment = !press.state.light.environment;
  return {};
}

KeyResult step_lamp(const Press& press) {
  if (press.limits.lamps == 0) return {Wish::none, "lamps: none was given; see --lamp"};
  press.state.light.lamp = step(press.state.light.lamp, press.key == 'k' ? 1 : -1, press.limits.lamps);
  return {};
}

KeyResult step_hour(const Press& press) {
  if (!press.limits.has_suns) return {Wish::none, "time of day: no light is the sun at an hour; see --light"};
  press.state.light.sun_hours += press.key == 't' ? 0.25 : -0.25;
  return {};
}

KeyResult toggle_sensor(const Press& press) {
  if (!press.limits.has_camera) return {Wish::none, "sensor: no camera was given; see --sensor"};
  press.state.light.other_sensor = !press.state.light.other_sensor;
  return {};
}

KeyResult step_bands(const Press& press) {
  press.state.bands = std::clamp(press.state.bands + (press.key == ']' ? 1 : -1), 1, press.limits.bands);
  return {};
}

/// Changes the brightness of a difference or of a picture, whichever is shown.
KeyResult step_brightness(const Press& press) {
  const double sign = press.key == '-' ? -1 : 1;
  if (press.state.show == Show::difference)
    press.state.difference_gain = std::clamp(press.state.difference_gain * std::exp2(sign), 1.0, 1024.0);
  else
    press.state.exposure_stops = std::clamp(press.state.exposure_stops + 0.5 * sign, -20.0, 20.0);
  return {};
}

const std::vector<Binding>& bindings() {
  static const std::vector<Binding> table = {
      {"12345", "1 - 5", "Phong, normal map, vertex PRT, textured PRT, compressed", choose_technique},
      {"f", "f", "forward or deferred shading",
       [](const Press& press) {
         press.state.shading = press.state.shading == Shading::forward ? Shading::deferred : Shading::forward;
         return KeyResult{Wish::none, can_defer(press.state.technique) || press.state.shading == Shading::forward
                                          ? ""
                                          : "deferred shading is for textured PRT and compressed"};
       }},
      {"lL", "l  L", "light: given, directional, ball, hemisphere, ambient",
       [](const Press& press) {
         press.state.light.preset = step(press.state.light.preset, press.key == 'l' ? 1 : -1, 5);
         return KeyResult{};
       }},
      {"e", "e", "environment on or off", toggle_environment},
      {"kK", "k  K", "next, previous lamp of those given", step_lamp},
      {"tT", "t  T", "the sun a quarter of an hour later, earlier", step_hour},
      {"v", "v", "seen by the camera, or by the CIE's observer", toggle_sensor},
      {"w", "w", "window of the light: none, Hann, Lanczos, dering",
       [](const Press& press) {
         press.state.light.window = step(press.state.light.window, 1, 4);
         return KeyResult{};
       }},
      {"[]", "[  ]", "fewer, more bands of the light", step_bands},
      {"+=-", "+  -", "exposure; of a difference its scale", step_brightness},
      {"p", "p", "the picture again",
       [](const Press& press) {
         press.state.show = Show::picture;
         return KeyResult{};
       }},
      {".,", ".  ,", "next, previous coefficient of the transfer",
       [](const Press& press) { return step_coefficient(press, press.key == '.' ? 1 : -1); }},
      {"n", "n", "normals", [](const Press& press) { return toggle_show(press, Show::normals); }},
      {"c", "c", "charts of the atlas", toggle_charts},
      {"d", "d", "difference from full textured PRT", toggle_difference},
      {"m", "m", "edges of the mesh",
       [](const Press& press) {
         press.state.mesh = !press.state.mesh;
         return KeyResult{};
       }},
      {"i", "i", "the panel of what is shown",
       [](const Press& press) {
         press.state.readout = !press.state.readout;
         return KeyResult{};
       }},
      {"h", "h", "keys",
       [](const Press& press) {
         press.state.help = !press.state.help;
         return KeyResult{};
       }},
      {"s", "s", "screenshot, without the panels",
       [](const Press&) {
         return KeyResult{Wish::screenshot, ""};
       }},
      {"r", "r", "reset all",
       [](const Press& press) {
         press.state = press.home;
         limit(press.state, press.limits);
         return KeyResult{};
       }},
      {std::string("q") + escape_key, "q  Esc", "close",
       [](const Press&) {
         return KeyResult{Wish::close, ""};
       }},
  };
  return table;
}

}  // namespace

KeyResult press(ViewState& state, const ViewLimits& limits, const ViewState& home, char key) {
  for (const Binding& binding : bindings())
    if (binding.keys.find(key) != std::string::npos) return binding.act({state, limits, home, key});
  return {};
}

std::vector<std::pair<std::string, std::string>> key_help() {
  std::vector<std::pair<std::string, std::string>> rows;
  for (const Binding& binding : bindings()) rows.emplace_back(binding.shown, binding.does);
  rows.emplace_back("left drag", "orbit");
  rows.emplace_back("middle drag", "pan; also shift and left drag");
  rows.emplace_back("right drag", "move the main light");
  rows.emplace_back("wheel", "zoom");
  return rows;
}

std::string key_help_text() {
  std::string text;
  for (const auto& [keys, does] : key_help()) text += "  " + keys + std::string(14 - keys.size(), ' ') + does + "\n";
  return text;
}

char key_named(std::string_view name) {
  if (name == "escape") return escape_key;
  if (name.size() != 1) return 0;
  const auto knows = [&](const Binding& binding) { return binding.keys.find(name) != std::string::npos; };
  return std::any_of(bindings().begin(), bindings().end(), knows) ? name.front() : '\0';
}

}  // namespace kiln
