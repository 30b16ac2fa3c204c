// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

#include "bake/bake_settings.h"
#include "bake/engines/gather_engine.h"
#include "bake/engines/transfer_engine.h"
#include "bake/scene/occluders.h"

namespace kiln {

/// Returns the backend of the settings; for `automatic` egl where EGL has a GPU, else beams, or embree for few
/// directions. The settings alone decide, no clock, so that the same bake has the same bytes.
BakeBackend choose_backend(const BakeSettings& settings);

/// Returns how far rays start off their receivers, object units: the settings' fraction of the occluders' diagonal, or
/// by default the rounding of their positions (rounding_offset). `hull` has the corners of the occluders' hull.
float ray_offset_of(const BakeSettings& settings, std::span<const Eigen::Vector3f> hull);

/// Returns the engine of a backend that is not automatic. `threads` is for a software GL renderer.
/// `settings.shadow_size` is not automatic (shadow_choice.h). `occluders` outlives the engine. Throws MachineLacks
/// where the backend cannot run.
std::unique_ptr<TransferEngine> make_engine(BakeBackend backend, const Occluders& occluders,
                                            const BakeSettings& settings, int threads);

/// Returns the engine that gathers bounced light beside the engine of `backend`, which is not automatic.
std::unique_ptr<GatherEngine> make_gather_engine(BakeBackend backend, const ReflectingSurface& surface,
                                                 const BakeSettings& settings, int threads);

}  // namespace kiln
