// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/backends.h"

#include "bake/egl/bundle_engine.h"
#include "bake/egl/egl_engine.h"
#include "bake/rays/beam_engine.h"
#include "bake/rays/embree_engine.h"
#include "bake/rays/embree_shadow_rays.h"
#include "bake/rays/mixed_engine.h"
#include "bake/rays/ray_gather_engine.h"
#include "gpu/egl_context.h"
#include "mesh/triangle_mesh.h"
#include "sh/directions.h"
#include "sh/ray_offset.h"
#include "sh/transfer_sums.h"

namespace kiln {

namespace {

/// Directions from which on beams are faster than rays for most receivers (docs/benchmarks.md): blocks of fewer
/// directions are too wide for one search to settle many of them, and a pilot costs more than it saves.
constexpr int enough_for_beams = 192;

/// Returns directions as dense as those of the bake; for a bake to a target error, whose number is not known yet, as
/// dense as the most it may take.
std::vector<Eigen::Vector3f> planned(const BakeSettings& settings) {
  constexpr int by_error = 1024;
  std::vector<Eigen::Vector3f> directions =
      sample_directions(Sampling::fibonacci, settings.max_error.wanted ? by_error : settings.directions, 1);
  order_coherently(directions, block_directions);
  return directions;
}

}  // namespace

BakeBackend choose_backend(const BakeSettings& settings) {
  if (settings.backend != BakeBackend::automatic) return settings.backend;
  if (has_hardware_egl(settings.gl_device)) return BakeBackend::egl;
  const bool is_few = settings.directions < enough_for_beams && !settings.max_error.wanted;
  return is_few ? BakeBackend::embree : BakeBackend::mixed;
}

float ray_offset_of(const BakeSettings& settings, std::span<const Eigen::Vector3f> hull) {
  if (!settings.ray_offset) return rounding_offset(hull);
  return static_cast<float>(*settings.ray_offset) * bounding_box(hull).diagonal();
}

std::unique_ptr<TransferEngine> make_engine(BakeBackend backend, const Occluders& occluders,
                                            const BakeSettings& settings, int threads) {
  const TransferScene scene{occluders.mesh.positions, occluders.mesh.triangles, occluders.hull, occluders.closed};
  const float ray_offset = ray_offset_of(settings, occluders.hull);
  if (backend == BakeBackend::beams) return std::make_unique<BeamEngine>(scene, ray_offset);
  if (backend == BakeBackend::embree) return std::make_unique<EmbreeEngine>(scene, ray_offset);
  if (backend == BakeBackend::mixed) return std::make_unique<MixedEngine>(scene, ray_offset, planned(settings));
  ShadowMapSettings shadows = settings.shadows;
  shadows.size_texels = settings.shadow_size;
  return std::make_unique<EglEngine>(scene, settings.gl_device, threads, shadows, make_shadow_rays(scene, ray_offset));
}

std::unique_ptr<GatherEngine> make_gather_engine(BakeBackend backend, const ReflectingSurface& surface,
                                                 const BakeSettings& settings, int threads) {
  if (backend == BakeBackend::egl) {
    ShadowMapSettings shadows = settings.shadows;
    shadows.size_texels = settings.shadow_size > 0 ? settings.shadow_size : shadows.size_texels;
    return std::make_unique<BundleEngine>(surface, settings.gl_device, threads, shadows);
  }
  return std::make_unique<RayGatherEngine>(surface, ray_offset_of(settings, surface.hull),
                                           backend == BakeBackend::beams || backend == BakeBackend::mixed);
}

}  // namespace kiln
