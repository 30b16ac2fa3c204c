// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "asset/prt_asset.h"
#include "image/image.h"
#include "sh/lights.h"

namespace kiln {

/// Weights that turn an asset's stored values into light: exit radiance (linear RGB) = constant + sum over planes of
/// scale * stored value (0 to 1). They combine the expansion of the ranges, the light and the albedo, since all of them
/// are linear: albedo L (min + s (max - min)) = albedo L min + albedo L (max - min) s. shaders/common_prt.glsl
/// evaluates the same sum.
struct PlaneWeights {
  Eigen::Vector3f constant = Eigen::Vector3f::Zero();
  std::vector<Eigen::Vector3f> scales;  ///< one per plane, RGB
};

/// Computes the weights of each cluster of a compressed asset, or the single ones of any other asset. For a compressed
/// asset the constant includes the clusters' means, and the scales the dot products of basis vectors with the light:
/// the terms in brackets of [D3DX]'s equation,
///
///   R_p = (M_k . L') + sum_j w_pj (B_kj . L'),
///
/// which are computed once per light. `light` has three channels (R, G, B) and the asset's bands. An asset of one
/// channel has the same transfer for all colours; an asset of three has one for each. Throws std::invalid_argument for
/// any other light, and BadInput for any other number of channels: those are spectral basis functions, which need
/// sensor matrices to become colours.
std::vector<PlaneWeights> cluster_weights(const PrtAsset& asset, const LightCoefficients& light,
                                          const std::array<float, 3>& albedo);

/// Computes weights for transfer vectors themselves instead of stored values: one scale per number of a vector;
/// `constant` is 0.
PlaneWeights vector_weights(const PrtAsset& asset, const LightCoefficients& light, const std::array<float, 3>& albedo);

/// Computes the exit radiance of every texel on the CPU, as the GPU draws it: three channels, rows from the bottom.
Image<float> relight_texels(const PrtAsset& asset, const LightCoefficients& light, const std::array<float, 3>& albedo);

}  // namespace kiln
