// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/backends.h"

#include "bake/egl/bundle_engine.h"
#include "bake/egl/egl_engine.h"
#include "bake/rays/beam_engine.h"
#include "bake/rays/embree_engine.h"
#include "bake/rays/embree_shadow_rays.h"
#include "bake/rays/ray_gather_engine.h"
#include "gpu/egl_context.h"
#include "sh/ray_offset.h"

namespace kiln {

namespace {

/// Number of directions from which on beams are faster than rays, on all meshes measured (docs/benchmarks.md): blocks
/// of fewer directions are too wide for one search to decide many of them.
constexpr int enough_for_beams = 192;

}  // namespace

BakeBackend choose_backend(const BakeSettings& settings) {
  if (settings.backend != BakeBackend::automatic) return settings.backend;
  if (has_hardware_egl(settings.gl_device)) return BakeBackend::egl;
  const bool is_few = settings.directions < enough_for_beams && !settings.max_error.wanted;
  return is_few ? BakeBackend::embree : BakeBackend::beams;
}

float ray_offset_of(const BakeSettings& settings, std::span<const Eigen::Vector3f> hull) {
  if (!settings.ray_offset) return rounding_offset(hull);
  return static_cast<float>(*settings.ray_offset) * diagonal_of(hull);
}

std::unique_ptr<TransferEngine> make_engine(BakeBackend backend, const Occluders& occluders,
                                            const BakeSettings& settings, int threads) {
  const TransferScene scene{occluders.mesh.positions, occluders.mesh.triangles, occluders.hull, occluders.closed};
  const float ray_offset = ray_offset_of(settings, occluders.hull);
  if (backend == BakeBackend::beams) return std::make_unique<BeamEngine>(scene, ray_offset);
  if (backend == BakeBackend::embree) return std::make_unique<EmbreeEngine>(scene, ray_offset);
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
                                           backend == BakeBackend::beams);
}

}  // namespace kiln
