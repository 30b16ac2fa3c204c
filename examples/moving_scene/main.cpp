// SPDX-License-Identifier: MIT
// Prints where the nodes of a scene are at some times, and the mean radiance of the light that arrives at the middle of
// each: moving_scene SCENE.yaml TIME...

#include <array>
#include <cstdio>
#include <cstdlib>
#include <kiln/scene.h>
#include <vector>

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: moving_scene SCENE.yaml TIME...\n");
    return 2;
  }
  try {
    kiln::runtime::SceneSettings settings;
    settings.light_points = 1;
    kiln::runtime::Scene scene = kiln::runtime::Scene::load(argv[1], settings);
    for (int k = 2; k < argc; ++k) {
      scene.set_time(std::strtod(argv[k], nullptr));
      for (int node = 0; node < scene.node_count(); ++node) {
        if (!scene.has_asset(node)) continue;
        const std::array<float, 16> place = scene.scene_from_object(node);
        const std::vector<float> light = scene.light(node);
        const double mean = light.front() * 0.28209479177387814;  // the first coefficient is sqrt(4 pi) times the mean
        std::printf("%s %s %.4f %.4f %.4f %.4f\n", argv[k], scene.name(node).c_str(), place[12], place[13], place[14],
                    mean);
      }
    }
  } catch (const kiln::runtime::Error& error) {
    std::fprintf(stderr, "moving_scene: %s\n", error.what());
    return 3;
  }
}
