// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "material/surface_opacity.h"
#include "mesh/triangle_mesh.h"
#include "normals/match_plan.h"
#include "normals/part_scene.h"
#include "raycast/buried_test.h"

namespace kiln {

/// Parts of a high mesh that texels are matched to, each on its own; without parts, the whole mesh as one.
class HighParts {
 public:
  /// Keeps a reference to `high`. Sheets of its `opacity` enclose nothing that could be buried.
  HighParts(const TriangleMesh& high, const MatchPlan& plan, const SurfaceOpacity& opacity = {});

  const PartScene& scene(std::uint32_t part) const { return scenes_[part]; }

  /// Returns 1 for each point that is buried in its own part, as BuriedTest does, else 0. `parts` has one part for each
  /// point.
  std::vector<std::uint8_t> buried(const Receivers& points, const std::vector<std::uint32_t>& parts) const;

 private:
  const TriangleMesh& high_;
  std::vector<PartScene> scenes_;
  std::vector<std::vector<std::uint32_t>> triangles_;  ///< those that enclose, by part; empty where all is one
  std::unique_ptr<BuriedTest> whole_test_;             ///< of that; those of parts are made when they are asked
};

}  // namespace kiln
