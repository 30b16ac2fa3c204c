#pragma once

#include <memory>

#include "bake/transfer_engine.h"

namespace kiln {

/// How receivers are compared with depth maps.
enum class ShadowFilter {
  nearest,     ///< one comparison
  two_by_two,  ///< bilinear mean of 2 x 2 comparisons (percentage-closer filtering: Reeves, Salesin and Cook 1987)
};

struct ShadowMapSettings {
  int size_texels = 1024;           ///< width and height of the depth map of one direction
  double depth_bias = 0;            ///< fraction of the occluders' extent along the direction
  double normal_offset_texels = 1;  ///< how far receivers are moved along their normal, in texels of the depth map
  ShadowFilter filter = ShadowFilter::two_by_two;
  int batch_directions = 16;  ///< depth maps alive at a time
  bool layered_pass = true;   ///< all maps of a batch in one pass, where GL can; the result is the same
};

/// Shadows by rasterising: for each direction an orthographic depth map of the occluders in as tight a frame as their
/// convex hull allows, against which all receivers are compared (US patent 7,948,490: directions outermost). A batch of
/// directions goes through one layered depth pass and one compute pass, which keeps the sums of the batch in registers.
/// Needs EGL and OpenGL 4.5, and of libraries Eigen alone.
class EglEngine : public TransferEngine {
 public:
  /// `device` and `software_threads` as EglContext takes them. Throws MachineLacks where there is no such context.
  EglEngine(const std::string& device, int software_threads, const ShadowMapSettings& settings);
  ~EglEngine() override;

  TransferVectors compute(const TransferRequest& request, const ProgressFunction& progress) override;
  std::string renderer() const override;
  bool is_software() const override;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace kiln
