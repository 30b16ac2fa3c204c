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
  // 64 x 64 texels; what faces the light has its radiance, 1, and that of the ambient light, 0.1.
  std::printf("%zu numbers, the brightest %.3f\n", radiance.size(), static_cast<double>(brightest));
  return radiance.size() == 3 * 64 * 64 && brightest > 0.7f && brightest < 1.2f ? 0 : 1;
}
