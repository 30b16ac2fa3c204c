// SPDX-License-Identifier: MIT
// Prints the exit radiance of points of an asset: cpu_radiance FOLDER LIGHT POINT...
// LIGHT is written as for kiln-render --light ("45,30"). A POINT is a texel, numbered row after row from the bottom, or
// a vertex.

#include <cstdio>
#include <cstdlib>
#include <kiln/asset.h>
#include <kiln/light.h>
#include <kiln/radiance.h>

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: cpu_radiance FOLDER LIGHT POINT...\n");
    return 2;
  }
  try {
    const auto asset = kiln::runtime::Asset::load(argv[1]);
    const std::vector<float> light = kiln::runtime::Light().from_text(argv[2]).coefficients(asset.bands());
    for (int k = 3; k < argc; ++k) {
      const auto point = static_cast<std::uint32_t>(std::strtoul(argv[k], nullptr, 10));
      const kiln::runtime::Color radiance = kiln::runtime::exit_radiance_at(asset, light, point);
      std::printf("%u %.6f %.6f %.6f\n", point, radiance[0], radiance[1], radiance[2]);
    }
  } catch (const kiln::runtime::Error& error) {
    std::fprintf(stderr, "cpu_radiance: %s\n", error.what());
    return 3;
  }
}
