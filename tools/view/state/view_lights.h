// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "asset/prt_asset.h"
#include "runtime/light/incident_samples.h"
#include "runtime/light/scene_lights.h"
#include "spectrum/sun_position.h"
#include "view/state/view_state.h"

namespace kiln {

/// Lights of the command line, and the box around which the viewer's own lights are placed.
struct GivenLights {
  std::vector<LightSpec> specs;
  std::optional<LightCoefficients> environment;
  BoundingBox box;
  std::vector<std::optional<SunHour>> suns = {};  ///< by spec, of those that are the sun at an hour; empty: none is
  std::vector<std::string> lamps = {};            ///< spectra to choose among, of the other lights; none: light is RGB
};

/// Makes the choice that leaves the given lights as they are.
LightChoice given_choice(const GivenLights& given, LightWindow window);

/// Returns the lights of a choice. The main light, to which azimuth and elevation belong, is the first given light that
/// has a direction; a ball goes around the box's centre at its original distance. If none has a direction, the
/// environment turns. Suns stand where they do at the choice's hour, and are dark below the horizon. By spectra all
/// lights are grey.
SceneLights lights_of(const LightChoice& choice, const GivenLights& given);

/// Names the spectrum of each of lights_of(choice, given), where light is not RGB.
std::vector<std::string> spectra_of(const LightChoice& choice, const GivenLights& given);

/// Returns how far about +Y a choice turns the given environment; 0 if another light is the main one.
double environment_turn_degrees(const LightChoice& choice, const GivenLights& given);

/// Computes the light of an asset at the origin, windowed, in the first `bands` of its bands; the others are 0.
AssetLight light_for_asset(const SceneLights& lights, int bands, const PrtAsset& asset, const IncidentSamples& samples);

/// Makes the light under which exit radiance is one transfer coefficient: in the colour of its channel if the asset has
/// three, in all colours if it has one.
AssetLight light_of_coefficient(int coefficient, const PrtAsset& asset, const IncidentSamples& samples);

/// Describes the first sun: "2026-06-21 15:30 UTC, elevation 38"; empty if there is none.
std::string describe_sun(const LightChoice& choice, const GivenLights& given);

/// Describes the main light by its kind, azimuth and elevation: "directional 45, 30" (degrees).
std::string describe(const LightChoice& choice, const GivenLights& given);

}  // namespace kiln
