#include "relight/relight.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <tbb/parallel_for.h>

#include "base/errors.h"

namespace kiln {

PlaneWeights plane_weights(const PrtAsset& asset, const LightCoefficients& light, const std::array<float, 3>& albedo) {
  if (light.bands != asset.bands || light.channels.size() != 3)
    throw std::invalid_argument("plane_weights: the light must have the asset's bands and three channels");
  if (asset.channels != 1 && asset.channels != 3)
    throw BadInput(asset.ranges_file.string(), "has " + std::to_string(asset.channels) + " channels, a spectral asset",
                   "1 channel or 3", "bake the asset with 1 channel or 3");
  Eigen::Vector3d constant = Eigen::Vector3d::Zero();
  PlaneWeights weights;
  for (const PrtPlane& plane : asset.planes) {
    Eigen::Vector3d level = Eigen::Vector3d::Zero();
    for (int colour = 0; colour < 3; ++colour)
      if (asset.channels == 1 || plane.channel == colour)
        level[colour] = static_cast<double>(albedo[colour]) * light.channels[colour][plane.coefficient];
    constant += level * plane.lowest;
    weights.scales.emplace_back((level * (plane.highest - plane.lowest)).cast<float>());
  }
  weights.constant = constant.cast<float>();
  return weights;
}

Image<float> relight_texels(const PrtAsset& asset, const LightCoefficients& light, const std::array<float, 3>& albedo) {
  const PlaneWeights weights = plane_weights(asset, light, albedo);
  const float white = std::exp2(static_cast<float>(asset.bits)) - 1;
  Image<float> radiance(asset.width, asset.height, 3);
  const auto relight = [&](const auto& pictures) {
    tbb::parallel_for(0, asset.height, [&](int j) {
      for (int i = 0; i < asset.width; ++i) {
        Eigen::Vector3f sum = weights.constant;
        for (std::size_t k = 0; k < pictures.size(); ++k) sum += weights.scales[k] * (pictures[k].at(i, j) / white);
        for (int colour = 0; colour < 3; ++colour) radiance.at(i, j, colour) = sum[colour];
      }
    });
  };
  std::visit(relight, asset.pictures);
  return radiance;
}

}  // namespace kiln
