// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bake/bake_settings.h"
#include "bake/scene/occluders.h"
#include "base/progress.h"
#include "sh/transfer.h"

namespace kiln {

struct ShadowSizeChoice {
  int size_texels = 0;
  double error = 0;      ///< of visibility: relative L2 of transfer vectors to rays along the same directions
  double floor = 0;      ///< what storing in settings.bits costs (quantisation_floor)
  bool reached = false;  ///< error <= floor; if no size does, the largest is taken
};

/// The smallest depth map of 256, 512, ... 4096 texels whose error of visibility is under the floor: measured with the
/// EGL engine and rays on `sample`, receivers spread evenly over the bake's, along settings.directions directions, at
/// most 512. Errors of single texels average out over directions, so a bake of more of them errs less than this.
/// Deterministic for one renderer. `threads` is for a software renderer. Throws MachineLacks where there is no EGL.
ShadowSizeChoice choose_shadow_size(const Receivers& sample, const Occluders& occluders, const BakeSettings& settings,
                                    int seed, int threads, const ProgressFunction& progress = no_progress);

}  // namespace kiln
