// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "bake/egl/shadow_maps.h"
#include "bake/engines/shadow_rays.h"
#include "bake/engines/transfer_engine.h"
#include "base/progress.h"

namespace kiln {

/// Engine that finds shadows by rasterising: for each direction it draws an orthographic depth map of the occluders, in
/// as tight a frame as their convex hull allows, and compares all receivers with it ([US 7,948,490]: directions
/// outermost). A batch of directions takes one layered depth pass and one compute pass that weighs every receiver; a
/// block of directions is then projected with its sums in registers. Needs EGL and OpenGL 4.5, and no library but
/// Eigen.
class EglEngine : public TransferEngine {
 public:
  /// `device` and `software_threads` as EglContext takes them. Throws MachineLacks where there is no such context.
  /// `rays` has the functions that `settings` need.
  EglEngine(const TransferScene& scene, const std::string& device, int software_threads,
            const ShadowMapSettings& settings, ShadowRays rays = {});
  ~EglEngine() override;

  void set_receivers(const Receivers& receivers, int bands) override;
  void add(std::span<const Eigen::Vector3f> directions, const ProgressFunction& progress) override;
  TransferSums sums() override;
  TransferWork work() const override;
  std::string renderer() const override;
  bool is_software() const override;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace kiln
