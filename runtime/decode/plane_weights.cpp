// SPDX-License-Identifier: MIT
#include "runtime/decode/plane_weights.h"

#include <cmath>
#include <span>
#include <stdexcept>
#include <string>

#include "base/errors.h"
#include "base/function_ref.h"
#include "base/parallel.h"

namespace kiln {

namespace {

/// What leaves a texel, without memory of its own.
using Levels = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, most_light_functions, 1>;

/// Multiplies a transfer vector (channels * bands^2 values) by a light, as `readers` read it.
Levels lit(const PrtAsset& asset, const LightCoefficients& light, const LightReaders& readers,
           std::span<const float> transfer) {
  const std::size_t coefficients = static_cast<std::size_t>(asset.bands) * asset.bands;
  Levels sum = Levels::Zero(readers.front().rows());
  for (std::size_t channel = 0; channel < readers.size(); ++channel)
    for (std::size_t k = 0; k < light.channels.size(); ++k) {
      const auto column = readers[channel].col(static_cast<Eigen::Index>(k)).cast<double>();
      if (column.isZero(0)) continue;
      sum += column * dot_product(transfer.subspan(channel * coefficients, coefficients), light.channels[k]);
    }
  return sum;
}

/// Returns what `reader` reads of a coefficient of a light.
Levels read_coefficient(const LightReader& reader, const LightCoefficients& light, int coefficient) {
  Levels sum = Levels::Zero(reader.rows());
  for (std::size_t k = 0; k < light.channels.size(); ++k)
    sum += reader.col(static_cast<Eigen::Index>(k)).cast<double>() *
           static_cast<double>(light.channels[k][static_cast<std::size_t>(coefficient)]);
  return sum;
}

/// Makes the weights of planes for each of which `level` returns the light per unit, on top of `constant`.
PlaneWeights weights_of(const PrtAsset& asset, Levels constant, FunctionRef<Levels(const PrtPlane& plane)> level) {
  PlaneWeights weights;
  weights.scales.resize(constant.size(), static_cast<Eigen::Index>(asset.planes.size()));
  for (std::size_t k = 0; k < asset.planes.size(); ++k) {
    const Levels unit = level(asset.planes[k]);
    constant += unit * asset.planes[k].range.lowest;
    weights.scales.col(static_cast<Eigen::Index>(k)) = (unit * asset.planes[k].range.width()).cast<float>();
  }
  weights.constant = constant.cast<float>();
  return weights;
}

/// Throws unless `light` and `readers` fit the asset.
void require_light(const PrtAsset& asset, const LightCoefficients& light, const LightReaders& readers) {
  bool fits = light.bands == asset.bands && readers.size() == static_cast<std::size_t>(asset.channels);
  for (const LightReader& reader : readers)
    fits = fits && reader.cols() == static_cast<Eigen::Index>(light.channels.size()) &&
           reader.rows() == readers.front().rows();
  if (!fits)
    throw std::invalid_argument("cluster_weights: the light must have the asset's bands and the readers' channels");
}

}  // namespace

LightReaders rgb_readers(const PrtAsset& asset, const std::array<float, 3>& albedo) {
  if (asset.channels != 1 && asset.channels != 3)
    throw BadInput(asset.ranges_file.string(), "has " + std::to_string(asset.channels) + " channels, a spectral asset",
                   "1 channel or 3", "draw it with kiln-render --lamp, or bake the asset with 1 channel or 3");
  const LightReader all = Eigen::Vector3f(albedo[0], albedo[1], albedo[2]).asDiagonal();
  if (asset.channels == 1) return {all};
  LightReaders readers(3, LightReader::Zero(3, 3));
  for (Eigen::Index c = 0; c < 3; ++c) readers[static_cast<std::size_t>(c)](c, c) = all(c, c);
  return readers;
}

std::vector<PlaneWeights> cluster_weights(const PrtAsset& asset, const LightCoefficients& light,
                                          const LightReaders& readers) {
  require_light(asset, light, readers);
  if (!asset.clusters)
    return {weights_of(asset, Levels::Zero(readers.front().rows()), [&](const PrtPlane& plane) {
      return read_coefficient(readers[static_cast<std::size_t>(plane.channel)], light, plane.coefficient);
    })};
  std::vector<PlaneWeights> weights;
  for (int cluster = 0; cluster < asset.clusters->count; ++cluster)
    weights.push_back(
        weights_of(asset, lit(asset, light, readers, asset.clusters->mean(cluster)), [&](const PrtPlane& plane) {
          return lit(asset, light, readers, asset.clusters->vector(cluster, plane.coefficient));
        }));
  return weights;
}

PlaneWeights vector_weights(const PrtAsset& asset, const LightCoefficients& light, const LightReaders& readers) {
  require_light(asset, light, readers);
  const Eigen::Index coefficients = asset.bands * asset.bands, outputs = readers.front().rows();
  PlaneWeights weights;
  weights.constant = Eigen::VectorXf::Zero(outputs);
  weights.scales.resize(outputs, asset.channels * coefficients);
  for (int channel = 0; channel < asset.channels; ++channel)
    for (int i = 0; i < coefficients; ++i)
      weights.scales.col(channel * coefficients + i) =
          read_coefficient(readers[static_cast<std::size_t>(channel)], light, i).cast<float>();
  return weights;
}

Image<float> relight_texels(const PrtAsset& asset, const LightCoefficients& light, const std::array<float, 3>& albedo) {
  const std::vector<PlaneWeights> clusters = cluster_weights(asset, light, rgb_readers(asset, albedo));
  const float white = std::exp2(static_cast<float>(asset.bits)) - 1;
  Image<float> radiance(asset.width, asset.height, 3);
  const auto relight = [&](const auto& pictures) {
    parallel_for(0, asset.height, [&](int j) {
      for (int i = 0; i < asset.width; ++i) {
        const std::size_t texel = static_cast<std::size_t>(j) * asset.width + i;
        const PlaneWeights& weights = clusters[asset.clusters ? asset.clusters->of_texel(texel) : 0];
        Eigen::Vector3f sum = weights.constant;
        for (std::size_t k = 0; k < pictures.size(); ++k)
          sum += weights.scales.col(static_cast<Eigen::Index>(k)) * (pictures[k].at(i, j) / white);
        for (int color = 0; color < 3; ++color) radiance.at(i, j, color) = sum[color];
      }
    });
  };
  std::visit(relight, asset.pictures);
  return radiance;
}

}  // namespace kiln
