// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "bake/engines/gather_engine.h"
#include "bake/engines/shadow_settings.h"
#include "base/progress.h"

namespace kiln {

/// Engine that gathers by rasterising: for each direction it draws all layers of the surface (bundle_lists.h), of which
/// a receiver takes the nearest before it; biases are those of EglEngine. A block of directions is then summed with its
/// sums in registers. Needs EGL and OpenGL 4.5, and no library but Eigen.
class BundleEngine : public GatherEngine {
 public:
  /// Takes `device` and `software_threads` as EglContext does, and the size, biases and batch count of `settings`.
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
