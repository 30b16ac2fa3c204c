#include "bake/bake.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "bake/egl_engine.h"
#include "bake/embree_engine.h"
#include "base/command_line.h"

namespace kiln {

namespace {

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

TransferVectors integrate(TransferEngine& engine, const Receivers& receivers,
                          std::span<const Eigen::Vector3f> directions, int bands, const ProgressFunction& progress) {
  engine.set_receivers(receivers, bands);
  engine.add(directions, progress);
  return engine.sums().transfer();
}

/// Every `step`-th receiver's transfer.
TransferVectors thin_out(const TransferVectors& transfer, std::size_t step) {
  TransferVectors thinned((transfer.receivers + step - 1) / step, transfer.coefficients);
  for (int i = 0; i < transfer.coefficients; ++i)
    for (std::size_t r = 0; r < thinned.receivers; ++r) thinned.plane(i)[r] = transfer.plane(i)[r * step];
  return thinned;
}

}  // namespace

BakeResult bake(const TexelReceivers& receivers, const Occluders& occluders, const BakeSettings& settings, int seed,
                int threads, const ProgressFunction& progress) {
  const Stopwatch stopwatch;
  const std::vector<Eigen::Vector3f> directions = sample_directions(settings.sampling, settings.directions, seed);
  const std::unique_ptr<TransferEngine> engine = make_engine(settings.backend, occluders, settings, threads);
  BakeResult result;
  result.transfer = integrate(*engine, receivers.view(), directions, settings.bands, progress);
  result.renderer = engine->renderer();
  result.software_renderer = engine->is_software();
  result.seconds = stopwatch.seconds();
  return result;
}

BakeVerification verify(const BakeResult& result, const TransferVectors& stored, const TexelReceivers& receivers,
                        const Occluders& occluders, const BakeSettings& settings, int seed, int threads,
                        const ProgressFunction& progress) {
  BakeVerification verification;

  // Step 1: the other backend, over the very same directions.
  const BakeBackend other = settings.backend == BakeBackend::egl ? BakeBackend::embree : BakeBackend::egl;
  const std::vector<Eigen::Vector3f> directions = sample_directions(settings.sampling, settings.directions, seed);
  const std::unique_ptr<TransferEngine> engine = make_engine(other, occluders, settings, threads);
  const TransferVectors other_transfer = integrate(*engine, receivers.view(), directions, settings.bands,
                                                   [&](double fraction) { progress(0.5 * fraction); });
  verification.other_backend = engine->renderer();
  const bool rays_are_other = other == BakeBackend::embree;
  verification.backend_difference =
      rays_are_other ? relative_l2(result.transfer, other_transfer) : relative_l2(other_transfer, result.transfer);

  // Step 2: many rays, from some of the texels.
  const std::size_t all = receivers.texels.size();
  const std::size_t step = std::max<std::size_t>(1, all / settings.verify_texels);
  std::vector<Eigen::Vector3f> positions, normals;
  for (std::size_t r = 0; r < all; r += step) {
    positions.push_back(receivers.positions[r]);
    normals.push_back(receivers.normals[r]);
  }
  const std::vector<Eigen::Vector3f> many =
      sample_directions(Sampling::fibonacci, settings.verify_directions, seed + 1u);
  const TransferVectors reference =
      integrate(*make_engine(BakeBackend::embree, occluders, settings, threads), {positions, normals}, many,
                settings.bands, [&](double fraction) { progress(0.5 + 0.5 * fraction); });
  verification.reference_directions = settings.verify_directions;
  verification.reference_texels = positions.size();
  verification.integration_error = relative_l2(thin_out(result.transfer, step), reference);
  verification.error = relative_l2(thin_out(stored, step), reference);
  verification.relighting_error = expected_relighting_error(thin_out(stored, step), reference);
  return verification;
}

}  // namespace kiln
