// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "asset/prt_asset.h"
#include "runtime/light/incident_samples.h"
#include "runtime/light/scene_lights.h"
#include "view/state/view_state.h"

namespace kiln {

/// The lights of the command line, and the box that the lights of the viewer are placed around.
struct GivenLights {
  std::vector<LightSpec> specs;
  std::optional<LightCoefficients> environment;
  BoundingBox box;
};

/// The choice that leaves the given lights as they are.
LightChoice given_choice(const GivenLights& given, LightWindow window);

/// The lights of a choice. The main light, which azimuth and elevation are of, is the first of the given ones that has
/// a direction; a ball goes around the box' centre, as far away as it was. Where none has, the environment is turned.
SceneLights lights_of(const LightChoice& choice, const GivenLights& given);

/// How far about +Y a choice turns the environment from where it was given; 0 where the main light is another.
double environment_turn_degrees(const LightChoice& choice, const GivenLights& given);

/// What they are to an asset at the origin in the first `bands` bands, windowed for as many; its others are 0.
AssetLight light_for_asset(const SceneLights& lights, int bands, const PrtAsset& asset, const IncidentSamples& samples);

/// The light under which exit radiance is one transfer coefficient, in the colour of its channel where the asset has
/// three, in all colours where it has one.
AssetLight light_of_coefficient(int coefficient, const PrtAsset& asset, const IncidentSamples& samples);

/// "directional 45, 30": what the main light is, its azimuth and its elevation, degrees.
std::string describe(const LightChoice& choice, const GivenLights& given);

}  // namespace kiln
