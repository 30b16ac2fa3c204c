// SPDX-License-Identifier: MIT
// Runs the block of docs/scenes.md: the small bunny stands where its circle is after a quarter, and has a light at
// every vertex.
#include <array>
#include <cmath>
#include <cstdio>
#include <kiln/asset.h>
#include <kiln/scene.h>
#include <vector>

int main() {
#include "scenes_1.inc"
  const std::array<float, 3> expected = {2, 1, 0};
  for (std::size_t k = 0; k < 3; ++k)
    if (std::abs(place[12 + k] - expected[k]) > 1e-5f) {
      std::fprintf(stderr, "found %g at %zu; expected %g\n", place[12 + k], k, expected[k]);
      return 1;
    }
  const std::size_t coefficients = static_cast<std::size_t>(bunny.bands()) * static_cast<std::size_t>(bunny.bands());
  return light.size() == bunny.positions().size() / 3 * 3 * coefficients && scene.duration() == 4 ? 0 : 1;
}
