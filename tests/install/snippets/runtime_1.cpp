// SPDX-License-Identifier: MIT
// Computes the radiance of the ball in out/bunny/prt by the lines of runtime/README.md, and checks it.

#include <algorithm>
#include <cstdio>
#include <kiln/asset.h>
#include <kiln/light.h>
#include <kiln/radiance.h>
#include <vector>

int main() {
#include "runtime_1.inc"

  const float brightest = *std::max_element(radiance.begin(), radiance.end());
  // Texels are 64 x 64. The ball is white; what faces the light has its radiance, 1, and that of the ambient light,
  // 0.1, up to a step of 8 bits in each of 9 planes.
  std::printf("%zu numbers, the brightest %.3f\n", radiance.size(), static_cast<double>(brightest));
  return radiance.size() == 3 * 64 * 64 && brightest > 1.07f && brightest < 1.11f ? 0 : 1;
}
