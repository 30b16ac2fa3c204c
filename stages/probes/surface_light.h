// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/progress.h"
#include "material/scene_mesh.h"
#include "probes/probes_settings.h"
#include "raycast/sent_light.h"
#include "raycast/surface_cache.h"

namespace kiln {

/// Light that a surface sends out of the distant light, all bounces together: exit radiance of channel c at point p of
/// the cache is the sum over j of L_j values[(p * channels + c) * bands^2 + j]. One channel where all albedos are grey,
/// else three.
struct SurfaceLight : SentLight {
  SurfaceCache cache;
  int bounces = 0;        ///< bounces taken
  double last_share = 0;  ///< share of the last bounce in all light, relative L2
};

/// Lights the scene's surface over `directions` and lets light bounce off it: r^1 = rho t^0, where t^0 is the transfer
/// of distant light, and r^b = rho / pi times the integral of max(0, n.s) r^(b-1)(q(s)) ds, where q is the surface
/// point seen along s from the front. Returns the sum of r^1 to r^n, n being settings.bounces; with auto, n is reached
/// when a bounce adds less than a thousandth.
SurfaceLight light_surface(const SceneMesh& scene, const ProbesSettings& settings, int seed,
                           const ProgressFunction& progress = no_progress);

}  // namespace kiln
