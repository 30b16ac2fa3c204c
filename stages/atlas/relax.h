// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "atlas/chart.h"

namespace kiln {

struct RelaxSettings {
  int iterations = 8;
  double tolerance =
      1e-4;  ///< stop when an iteration lowers the energy's excess over that of an isometry by less than this share
};

/// Moves the uvs of a flip-free chart towards an isometry without ever flipping a triangle: minimises the symmetric
/// Dirichlet energy, the mean over the surface of s1^2 + s2^2 + 1/s1^2 + 1/s2^2 (4 for an isometry), by reweighted
/// least squares steps. Returns the energy.
double relax(const Surface& surface, Chart& chart, const RelaxSettings& settings);

/// Relaxes while `goes_on` returns true; it is called with the chart's energy before the first step and after each. A
/// chart with flipped triangles is first brought to a nearby map without any, by a few as-rigid-as-possible steps;
/// returns false where these do not succeed.
bool relax_until(const Surface& surface, Chart& chart, const std::function<bool(double energy)>& goes_on);

/// Relaxes some triangles around the vertices `seeds` of a large chart, the rest of which does not move; triangles
/// there may be flipped before. Returns false where they stay flipped.
bool relax_around(const Surface& surface, Chart& chart, const std::vector<std::uint32_t>& seeds, std::size_t most_faces,
                  const RelaxSettings& settings);

}  // namespace kiln
