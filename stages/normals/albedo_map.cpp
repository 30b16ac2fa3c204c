// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/albedo_map.h"

#include <algorithm>

#include "base/json.h"
#include "image/gutter.h"
#include "image/srgb.h"
#include "maps/seam_solver.h"

namespace kiln {

AlbedoMap make_albedo_map(Image<float> linear, const std::vector<std::uint8_t>& known,
                          const std::vector<std::uint8_t>& covered, const Seams& seams, SeamChoice choice) {
  fill_gutters(linear, known);
  AlbedoMap map;
  map.seam_before = seams.mismatch(linear_from_srgb_bytes(srgb_bytes(linear)));
  if (choice == SeamChoice::equalise && !seams.edges().empty()) {
    // Repeat, because clamping undoes some of it.
    constexpr int rounds = 3;
    const SeamSolver solver(seams, covered);
    for (int round = 0; round < rounds; ++round) {
      solver.equalise(linear);
      for (float& value : linear.values()) value = std::clamp(value, 0.f, 1.f);
    }
  }
  map.picture = srgb_bytes(linear);
  map.seam_after = seams.mismatch(linear_from_srgb_bytes(map.picture));
  return map;
}

Json AlbedoMap::to_json() const {
  return {{"width", picture.width()},
          {"height", picture.height()},
          {"error_rms", error.rms},
          {"error_p95", error.percentile_95},
          {"seam_mismatch_mean_before", seam_before.mean},
          {"seam_mismatch_max_before", seam_before.largest},
          {"seam_mismatch_mean", seam_after.mean},
          {"seam_mismatch_max", seam_after.largest}};
}

}  // namespace kiln
