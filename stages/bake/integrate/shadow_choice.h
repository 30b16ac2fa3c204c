// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bake/bake_job.h"
#include "bake/bake_reports.h"
#include "sh/transfer.h"

namespace kiln {

/// Returns the smallest depth map of 256, 512, ... 4096 texels whose error of visibility is under the quantisation
/// error: measured with the EGL engine and rays on `sample`, receivers spread evenly over the bake's, along
/// settings.directions directions, at most 512. Errors of single texels average out over directions, so a bake of more
/// directions errs less than this. Deterministic for one renderer. Throws MachineLacks where there is no EGL.
ShadowSizeChoice choose_shadow_size(const Receivers& sample, const BakeJob& job);

}  // namespace kiln
