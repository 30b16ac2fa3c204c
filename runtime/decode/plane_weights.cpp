// SPDX-License-Identifier: MIT
#include "runtime/decode/plane_weights.h"

#include <cmath>
#include <span>
#include <stdexcept>
#include <string>

#include "base/errors.h"
#include "base/parallel.h"

namespace kiln {

namespace {

/// Multiplies a transfer vector (channels * bands^2 values) by a light: RGB.
Eigen::Vector3d lit(const PrtAsset& asset, const LightCoefficients& light, std::span<const float> transfer) {
  const std::size_t coefficients = static_cast<std::size_t>(asset.bands) * asset.bands;
  Eigen::Vector3d radiance = Eigen::Vector3d::Zero();
  for (std::size_t color = 0; color < 3; ++color)
    radiance[static_cast<Eigen::Index>(color)] = dot_product(
        transfer.subspan(asset.channels == 1 ? 0 : color * coefficients, coefficients), light.channels[color]);
  return radiance;
}

/// Computes the weights of planes that hold coefficients.
PlaneWeights coefficient_weights(const PrtAsset& asset, const LightCoefficients& light, const Eigen::Vector3d& albedo) {
  Eigen::Vector3d constant = Eigen::Vector3d::Zero();
  PlaneWeights weights;
  for (const PrtPlane& plane : asset.planes) {
    Eigen::Vector3d level = Eigen::Vector3d::Zero();
    for (int color = 0; color < 3; ++color)
      if (asset.channels == 1 || plane.channel == color)
        level[color] = albedo[color] * light.channels[color][plane.coefficient];
    constant += level * plane.range.lowest;
    weights.scales.emplace_back((level * plane.range.width()).cast<float>());
  }
  weights.constant = constant.cast<float>();
  return weights;
}

/// Computes the weights of planes that hold weights of basis vectors.
PlaneWeights basis_weights(const PrtAsset& asset, int cluster, const LightCoefficients& light,
                           const Eigen::Vector3d& albedo) {
  Eigen::Vector3d constant = albedo.cwiseProduct(lit(asset, light, asset.clusters->mean(cluster)));
  PlaneWeights weights;
  for (const PrtPlane& plane : asset.planes) {
    const Eigen::Vector3d level =
        albedo.cwiseProduct(lit(asset, light, asset.clusters->vector(cluster, plane.coefficient)));
    constant += level * plane.range.lowest;
    weights.scales.emplace_back((level * plane.range.width()).cast<float>());
  }
  weights.constant = constant.cast<float>();
  return weights;
}

/// Throws unless the asset has colours, and `light` fits it.
void require_light(const PrtAsset& asset, const LightCoefficients& light) {
  if (light.bands != asset.bands || light.channels.size() != 3)
    throw std::invalid_argument("cluster_weights: the light must have the asset's bands and three channels");
  if (asset.channels != 1 && asset.channels != 3)
    throw BadInput(asset.ranges_file.string(), "has " + std::to_string(asset.channels) + " channels, a spectral asset",
                   "1 channel or 3", "draw it with kiln-render --lamp, or bake the asset with 1 channel or 3");
}

}  // namespace

std::vector<PlaneWeights> cluster_weights(const PrtAsset& asset, const LightCoefficients& light,
                                          const std::array<float, 3>& albedo) {
  require_light(asset, light);
  const Eigen::Vector3d tint(albedo[0], albedo[1], albedo[2]);
  if (!asset.clusters) return {coefficient_weights(asset, light, tint)};
  std::vector<PlaneWeights> weights;
  for (int cluster = 0; cluster < asset.clusters->count; ++cluster)
    weights.push_back(basis_weights(asset, cluster, light, tint));
  return weights;
}

PlaneWeights vector_weights(const PrtAsset& asset, const LightCoefficients& light, const std::array<float, 3>& albedo) {
  require_light(asset, light);
  const int coefficients = asset.bands * asset.bands;
  PlaneWeights weights;
  for (int channel = 0; channel < asset.channels; ++channel)
    for (int i = 0; i < coefficients; ++i) {
      Eigen::Vector3f scale = Eigen::Vector3f::Zero();
      for (int color = 0; color < 3; ++color)
        if (asset.channels == 1 || channel == color) scale[color] = albedo[color] * light.channels[color][i];
      weights.scales.push_back(scale);
    }
  return weights;
}

Image<float> relight_texels(const PrtAsset& asset, const LightCoefficients& light, const std::array<float, 3>& albedo) {
  const std::vector<PlaneWeights> clusters = cluster_weights(asset, light, albedo);
  const float white = std::exp2(static_cast<float>(asset.bits)) - 1;
  Image<float> radiance(asset.width, asset.height, 3);
  const auto relight = [&](const auto& pictures) {
    parallel_for(0, asset.height, [&](int j) {
      for (int i = 0; i < asset.width; ++i) {
        const std::size_t texel = static_cast<std::size_t>(j) * asset.width + i;
        const PlaneWeights& weights = clusters[asset.clusters ? asset.clusters->of_texel(texel) : 0];
        Eigen::Vector3f sum = weights.constant;
        for (std::size_t k = 0; k < pictures.size(); ++k) sum += weights.scales[k] * (pictures[k].at(i, j) / white);
        for (int color = 0; color < 3; ++color) radiance.at(i, j, color) = sum[color];
      }
    });
  };
  std::visit(relight, asset.pictures);
  return radiance;
}

}  // namespace kiln
