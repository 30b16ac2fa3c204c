// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "bake/engines/gather_engine.h"
#include "bake/engines/shadow_settings.h"

namespace kiln {

/// Gathers by rasterising: for each direction all layers of the surface (bundle_lists.h), of which a receiver takes the
/// nearest before it; biases as EglEngine has them. Then a block of directions is summed with the sums in registers.
/// Needs EGL and OpenGL 4.5, and of libraries Eigen alone.
class BundleEngine : public GatherEngine {
 public:
  /// `device` and `software_threads` as EglContext takes them; of `settings` the size, the biases and the batch count.
  /// Throws MachineLacks where there is no such context.
  BundleEngine(const ReflectingSurface& surface, const std::string& device, int software_threads,
               const ShadowMapSettings& settings);
  ~BundleEngine() override;

  void set_radiance(std::span<const float> values, int width) override;
  TransferSums gather(const Receivers& receivers, std::span<const Eigen::Vector3f> directions,
                      const ProgressFunction& progress) override;
  std::string renderer() const override;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace kiln
