// SPDX-License-Identifier: MIT
#include "runtime/shadow/moving_shadows.h"

#include <utility>

namespace kiln {

MovingShadows::MovingShadows(SceneTree tree, std::vector<ShadowObject> objects, const ShadowSettings& settings)
    : tree_(std::move(tree)), objects_(std::move(objects)), settings_(settings), light_(tree_.nodes.size()) {}

void MovingShadows::update(const ScenePoses& poses, const SceneLights& lights) {
  for (std::size_t k = 0; k < tree_.nodes.size(); ++k) {
    if (tree_.nodes[k].asset < 0) continue;
    const ShadowObject& object = objects_[static_cast<std::size_t>(tree_.nodes[k].asset)];
    light_[k] = light_asset(lights, object.bands, poses[k], object.points).samples;
  }
}

}  // namespace kiln
