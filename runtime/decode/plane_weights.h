// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "asset/prt_asset.h"
#include "image/image.h"
#include "sh/lights.h"

namespace kiln {

/// What a light makes of an asset's planes: exit radiance (linear RGB) = constant + sum over planes of scale * stored
/// value (0 to 1). The expansion of the ranges, the light and the albedo are all in it, since all of them are linear:
/// albedo L (min + s (max - min)) = albedo L min + albedo L (max - min) s. shaders/common_prt.glsl
/// evaluates the same.
struct PlaneWeights {
  Eigen::Vector3f constant = Eigen::Vector3f::Zero();
  std::vector<Eigen::Vector3f> scales;  ///< one per plane, RGB
};

/// One for every cluster of a compressed asset, one for any other. The constant of a compressed one has the clusters'
/// means in it, and the scales the dot products of basis vectors with the light: the terms in brackets of D3DX'
///
///   R_p = (M_k . L') + sum_j w_pj (B_kj . L'),
///
/// which are computed once per light. `light` has three channels (R, G, B) and the asset's bands. An asset of one
/// channel has the same transfer for all colours; of three, one for each. Throws std::invalid_argument for another
/// light, BadInput for another number of channels: those are spectral basis functions, which need sensor matrices to
/// become colours.
std::vector<PlaneWeights> cluster_weights(const PrtAsset& asset, const LightCoefficients& light,
                                          const std::array<float, 3>& albedo);

/// The same for transfer vectors as they are, `constant` being 0: one scale for each number of a vector.
PlaneWeights vector_weights(const PrtAsset& asset, const LightCoefficients& light, const std::array<float, 3>& albedo);

/// Exit radiance of every texel, three channels, rows from the bottom; what the GPU draws, computed by the CPU.
Image<float> relight_texels(const PrtAsset& asset, const LightCoefficients& light, const std::array<float, 3>& albedo);

}  // namespace kiln
