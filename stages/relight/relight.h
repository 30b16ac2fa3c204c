#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "image/image.h"
#include "relight/prt_asset.h"
#include "sh/lights.h"

namespace kiln {

/// What a light makes of an asset's planes: exit radiance (linear RGB) = constant + sum over planes of scale * stored
/// value (0 to 1). The expansion of the ranges, the light and the albedo are all in it, since all of them are linear:
/// albedo L (min + s (max - min)) = albedo L min + albedo L (max - min) s. shaders/common_prt.glsl evaluates the same.
struct PlaneWeights {
  Eigen::Vector3f constant = Eigen::Vector3f::Zero();
  std::vector<Eigen::Vector3f> scales;  ///< one per plane, RGB
};

/// `light` has three channels (R, G, B) and the asset's bands. An asset of one channel has the same transfer for all
/// colours; of three, one for each. Throws std::invalid_argument for another light, BadInput for another number of
/// channels: those are spectral basis functions, which need sensor matrices to become colours.
PlaneWeights plane_weights(const PrtAsset& asset, const LightCoefficients& light, const std::array<float, 3>& albedo);

/// Exit radiance of every texel, three channels, rows from the bottom; what the GPU draws, computed by the CPU.
Image<float> relight_texels(const PrtAsset& asset, const LightCoefficients& light, const std::array<float, 3>& albedo);

}  // namespace kiln
