// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "asset/prt_asset.h"
#include "image/image.h"
#include "sh/lights.h"

namespace kiln {

/// Most functions that light is a sum of, and most weights that leave a texel.
inline constexpr int most_light_functions = 8;

/// Weights that turn an asset's stored values into light: what leaves a texel = constant + sum over planes of scale *
/// stored value (0 to 1). They combine the expansion of the ranges, the light and the albedo, since all of them are
/// linear: albedo L (min + s (max - min)) = albedo L min + albedo L (max - min) s. shaders/common_prt.glsl evaluates
/// the same sum. What leaves is linear RGB, or weights of functions of light.
struct PlaneWeights {
  Eigen::VectorXf constant = {};
  Eigen::MatrixXf scales = {};  ///< a column per plane
};

/// How light becomes what leaves: for each channel of an asset's transfer a matrix from the channels of the light, the
/// functions that it is a sum of, to RGB or to other weights. Where the surface is the same everywhere, it holds the
/// sensor's matrix times the surface's [Peercy 1995].
using LightReader =
    Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, most_light_functions, most_light_functions>;
using LightReaders = std::vector<LightReader>;

/// Returns the readers of red, green and blue, times an albedo. An asset of one channel has the same transfer for all
/// colours; an asset of three has one for each. Throws BadInput for any other number of channels: those are
/// wavelengths, which need matrices of their own to become colours.
LightReaders rgb_readers(const PrtAsset& asset, const std::array<float, 3>& albedo);

/// Computes the weights of each cluster of a compressed asset, or the single ones of any other asset. For a compressed
/// asset the constant includes the clusters' means, and the scales the dot products of basis vectors with the light:
/// the terms in brackets of [D3DX]'s equation,
///
///   R_p = (M_k . L') + sum_j w_pj (B_kj . L'),
///
/// which are computed once per light. `light` has the asset's bands and the channels that the readers take; there is a
/// reader for each channel of the asset. Throws std::invalid_argument for any other.
std::vector<PlaneWeights> cluster_weights(const PrtAsset& asset, const LightCoefficients& light,
                                          const LightReaders& readers);

/// Computes weights for transfer vectors themselves instead of stored values: one scale per number of a vector;
/// `constant` is 0.
PlaneWeights vector_weights(const PrtAsset& asset, const LightCoefficients& light, const LightReaders& readers);

/// Computes the exit radiance of every texel on the CPU, as the GPU draws it: three channels, rows from the bottom.
Image<float> relight_texels(const PrtAsset& asset, const LightCoefficients& light, const std::array<float, 3>& albedo);

}  // namespace kiln
