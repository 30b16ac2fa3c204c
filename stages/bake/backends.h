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

/// `automatic` becomes egl where EGL has a GPU, else beams, but embree for few directions. The settings alone decide,
/// not a clock, so that the same bake has the same bytes.
BakeBackend choose_backend(const BakeSettings& settings);

/// How far rays start off their receivers, object units: what the settings say of the diagonal of the occluders, or
/// what the precision of their positions asks for (rounding_offset). `hull` holds the occluders.
float ray_offset_of(const BakeSettings& settings, std::span<const Eigen::Vector3f> hull);

/// The engine of a backend that is not automatic. `threads` is for a software GL renderer. Throws MachineLacks where it
/// cannot run. `settings.shadow_size` is not automatic (shadow_choice.h); `occluders` outlives the engine.
std::unique_ptr<TransferEngine> make_engine(BakeBackend backend, const Occluders& occluders,
                                            const BakeSettings& settings, int threads);

/// What gathers bounced light beside the engine of `backend`, not automatic either.
std::unique_ptr<GatherEngine> make_gather_engine(BakeBackend backend, const ReflectingSurface& surface,
                                                 const BakeSettings& settings, int threads);

}  // namespace kiln
