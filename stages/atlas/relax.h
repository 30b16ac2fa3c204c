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

/// Relaxes step by step: after each, and before the first, `goes_on` is told the chart's energy and says whether
/// to go on. A chart that has flipped triangles is first brought to a map near by that has none by a few
/// as-rigid-as-possible steps; false where these find none.
bool relax_until(const Surface& surface, Chart& chart, const std::function<bool(double energy)>& goes_on);

/// `relax` for some triangles around the vertices `seeds` of a large chart, the rest of which stays as it is;
/// triangles there may be flipped before. False where they stay so.
bool relax_around(const Surface& surface, Chart& chart, const std::vector<std::uint32_t>& seeds, std::size_t most_faces,
                  const RelaxSettings& settings);

}  // namespace kiln
