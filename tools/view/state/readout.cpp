// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/state/readout.h"

#include <cmath>
#include <fmt/format.h>
#include <sstream>

#include "view/state/keys.h"

namespace kiln {

namespace {

std::string window_name(LightWindow window) {
  switch (window) {
    case LightWindow::hann:
      return "Hann";
    case LightWindow::lanczos:
      return "Lanczos";
    case LightWindow::dering:
      return "dering";
    case LightWindow::none:
      break;
  }
  return "none";
}

/// Formats a number as "1,234,567".
std::string with_commas(std::uint64_t number) {
  std::string digits = std::to_string(number);
  for (int k = static_cast<int>(digits.size()) - 3; k > 0; k -= 3) digits.insert(static_cast<std::size_t>(k), ",");
  return digits;
}

std::string describe_environment(const LightChoice& light, const GivenLights& given) {
  if (!light.environment) return "off";
  const double turn_degrees = environment_turn_degrees(light, given);
  return turn_degrees == 0 ? "on" : fmt::format("on, turned by {:.0f}", turn_degrees);
}

std::string shown(const ViewState& state, const ViewLimits& limits, const ViewFacts& facts) {
  switch (state.show) {
    case Show::normals:
      return "normals, object space";
    case Show::charts:
      return "charts";
    case Show::difference:
      return fmt::format("difference x {:.0f}: red brighter, blue darker", state.difference_gain);
    case Show::coefficient: {
      const int count = limits.bands * limits.bands, i = state.coefficient % count;
      const int l = static_cast<int>(std::sqrt(i + 0.5)), m = i - l * (l + 1);
      const std::string channel =
          limits.channels > 1 ? fmt::format(", channel {}", state.coefficient / count) : std::string();
      return fmt::format("t{} (l {}, m {}){}, {:.3f} to {:.3f}, blue below 0", i, l, m, channel,
                         facts.coefficient_lowest, facts.coefficient_highest);
    }
    case Show::picture:
      break;
  }
  return state.exposure_stops == 0 ? "picture" : fmt::format("picture, {:+.1f} stops", state.exposure_stops);
}

}  // namespace

Panel readout(const ViewState& state, const ViewLimits& limits, const PrtAsset& asset, const GivenLights& lights,
              const ViewFacts& facts) {
  const bool is_deferred = state.shading == Shading::deferred && can_defer(state.technique);
  Panel panel{facts.asset, {}};
  const auto row = [&](const char* label, std::string value) { panel.rows.push_back({label, std::move(value)}); };
  row("Technique", technique_caption(state.technique, asset));
  row("Shading", is_deferred ? "deferred" : "forward");
  row("Shows", shown(state, limits, facts));
  row("Light", describe(state.light, lights));
  if (limits.lamps > 0) {
    const std::string& lamp = lights.lamps[static_cast<std::size_t>(state.light.lamp)];
    row("Lamp", limits.lamps > 1 ? fmt::format("{}, {} of {}", lamp, state.light.lamp + 1, limits.lamps) : lamp);
  }
  if (limits.has_suns) row("Sun", describe_sun(state.light, lights));
  if (limits.has_camera) row("Seen by", state.light.other_sensor ? "the CIE 1931 observer" : "the camera");
  if (limits.has_environment) row("Environment", describe_environment(state.light, lights));
  row("Window", window_name(state.light.window));
  row("Bands", fmt::format("{} of {}", state.bands, limits.bands));
  row("Triangles", with_commas(asset.mesh.triangles.size()));
  row("GPU memory", fmt::format("{:.2f} MB", static_cast<double>(facts.gpu_bytes) / 1e6));
  row("Frame", facts.frame_milliseconds > 0 ? fmt::format("{:.1f} ms", facts.frame_milliseconds) : "...");
  return panel;
}

Panel message_panel(const std::string& heading, const std::string& message) {
  constexpr std::size_t most_characters = 90;
  Panel panel{heading, {}};
  std::istringstream text(message);
  std::string line;
  for (std::string word; text >> word; line += (line.empty() ? "" : " ") + word)
    if (!line.empty() && line.size() + 1 + word.size() > most_characters) {
      panel.rows.push_back({"", line});
      line.clear();
    }
  if (!line.empty()) panel.rows.push_back({"", line});
  return panel;
}

Panel help_panel() {
  Panel panel{"Keys", {}};
  for (const auto& [keys, does] : key_help()) panel.rows.push_back({keys, does});
  return panel;
}

}  // namespace kiln
