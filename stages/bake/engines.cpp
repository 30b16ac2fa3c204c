#include "bake/engines.h"

#include "bake/egl_engine.h"
#include "bake/embree_engine.h"
#include "gpu/egl_context.h"

namespace kiln {

BakeBackend choose_backend(const BakeSettings& settings) {
  if (settings.backend != BakeBackend::automatic) return settings.backend;
  return has_hardware_egl(settings.gl_device) ? BakeBackend::egl : BakeBackend::embree;
}

std::unique_ptr<TransferEngine> make_engine(BakeBackend backend, const Occluders& occluders,
                                            const BakeSettings& settings, int threads) {
  const TransferScene scene{occluders.mesh.positions, occluders.mesh.triangles, occluders.hull, occluders.closed};
  if (backend == BakeBackend::embree) return std::make_unique<EmbreeEngine>(scene, settings.ray_offset);
  ShadowMapSettings shadows;
  shadows.size_texels = settings.shadow_size;
  shadows.depth_bias = settings.shadow_bias;
  shadows.normal_offset_texels = settings.normal_offset;
  shadows.filter =
      settings.shadow_filter == BakeShadowFilter::nearest ? ShadowFilter::nearest : ShadowFilter::two_by_two;
  return std::make_unique<EglEngine>(scene, settings.gl_device, threads, shadows);
}

}  // namespace kiln
