// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "mesh/triangle_mesh.h"
#include "raycast/ray_scene.h"
#include "sh/transfer.h"

namespace kiln {

/// Computes how thick a mesh is beneath points on it: the mean length of rays inwards to the first surface that they
/// meet, weighted by the cosine to the inward normal, in units of length; 4/3 r in a ball, twice the thickness of a
/// wide slab. Rays that meet nothing count with length 0, as beneath a sheet. The same directions, spread over the
/// sphere, serve all points, so neighbours differ without noise. `offset`, in units of length, is how far off the
/// surface rays begin.
std::vector<float> surface_thickness(const RayScene& scene, const Receivers& points, int directions, float offset);

}  // namespace kiln
