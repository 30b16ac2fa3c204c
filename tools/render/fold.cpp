// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/fold.h"

#include <algorithm>
#include <numeric>

#include "base/parallel.h"

namespace kiln {

namespace {

/// Stores transfer vectors of the asset's channels as planes of 16 bits.
void put_planes(PrtAsset& asset, const std::vector<float>& vectors) {
  constexpr int bits = 16;
  const int coefficients = asset.bands * asset.bands;
  const std::size_t length = asset.vector_length();
  const std::size_t places = vectors.size() / length;
  std::vector<Image<std::uint16_t>> pictures(length);
  asset.bits = bits;
  asset.planes.assign(length, {});
  parallel_for(std::size_t{0}, length, [&](std::size_t k) {
    std::vector<float> values(places);
    for (std::size_t p = 0; p < places; ++p) values[p] = vectors[p * length + k];
    PrtPlane& plane = asset.planes[k];
    plane.channel = static_cast<int>(k) / coefficients;
    plane.coefficient = static_cast<int>(k) % coefficients;
    plane.bits = bits;
    plane.range = range_of(values);
    pictures[k] = Image<std::uint16_t>(asset.width, asset.height, 1);
    std::ranges::transform(values, pictures[k].values().begin(), [&](float value) {
      return static_cast<std::uint16_t>(plane.range.store(static_cast<double>(value), bits));
    });
  });
  asset.pictures = std::move(pictures);
}

}  // namespace

Spectrum spectrum_of(const PrtReflectance& shipped) {
  SampledSpectrum sampled{shipped.name, {}, shipped.values};
  for (std::size_t k = 0; k < shipped.values.size(); ++k)
    sampled.wavelengths_nm.push_back(shipped.first_nm + static_cast<double>(k) * shipped.step_nm);
  return resample(sampled);
}

WavelengthFold::WavelengthFold(const PrtAsset& asset, const std::optional<Spectrum>& measured)
    : asset_(asset), at_wavelengths_(asset.spectrum->wavelengths_nm) {
  const PrtAlbedo& albedo = asset.albedo;
  if (measured)
    constant_ = at_wavelengths_.of(*measured);
  else if (!albedo.known)
    constant_.assign(at_wavelengths_.size(), 1.f);
  else if (albedo.picture.values().empty())
    constant_ = at_wavelengths_.of(albedo.constant);
  else
    at_wavelengths_.prepare_table();
  for (const PrtReflectance& reflectance : albedo.reflectances)
    of_materials_.push_back(at_wavelengths_.of(spectrum_of(reflectance)));
}

void WavelengthFold::shares_at(std::size_t place, std::span<float> shares) const {
  if (const PrtReflectance* material = constant_.empty() ? asset_.albedo.measured(place) : nullptr)
    std::ranges::copy(of_materials_[static_cast<std::size_t>(material - asset_.albedo.reflectances.data())],
                      shares.begin());
  else if (constant_.empty())
    at_wavelengths_.look_up(asset_.albedo.at(place), shares);
  else
    std::ranges::copy(constant_, shares.begin());
}

/// Returns transfer vectors of the channels, one place after another.
std::vector<float> WavelengthFold::vectors(const Eigen::MatrixXf& channels, std::size_t places) const {
  constexpr std::size_t at_once = 4096;
  const auto wavelengths = static_cast<Eigen::Index>(asset_.channels);
  const Eigen::Index coefficients = asset_.bands * asset_.bands;
  const std::size_t length = asset_.vector_length(),
                    folded_length = static_cast<std::size_t>(channels.rows() * coefficients);
  std::vector<float> folded(places * folded_length);
  parallel_for(std::size_t{0}, (places + at_once - 1) / at_once, [&](std::size_t block) {
    const std::size_t first = block * at_once, count = std::min(at_once, places - first);
    std::vector<std::uint32_t> texels(count);
    std::iota(texels.begin(), texels.end(), static_cast<std::uint32_t>(first));
    std::vector<float> decoded(asset_.is_per_vertex() ? 0 : count * length);
    if (!asset_.is_per_vertex()) decode_transfer(asset_, texels, decoded);
    const float* from = asset_.is_per_vertex() ? asset_.vertex_transfer.data() + first * length : decoded.data();
    std::vector<float> shares(static_cast<std::size_t>(wavelengths));
    for (std::size_t p = 0; p < count; ++p) {
      shares_at(first + p, shares);
      const Eigen::Map<const Eigen::MatrixXf> transfer(from + p * length, coefficients, wavelengths);
      const Eigen::Map<const Eigen::VectorXf> share(shares.data(), wavelengths);
      Eigen::Map<Eigen::MatrixXf> to(folded.data() + (first + p) * folded_length, coefficients, channels.rows());
      to.noalias() = transfer * share.asDiagonal() * channels.transpose();
    }
  });
  return folded;
}

PrtAsset WavelengthFold::through(const Eigen::MatrixXd& channels) const {
  const std::size_t places = asset_.is_per_vertex()
                                 ? asset_.vertex_transfer.size() / asset_.vector_length()
                                 : static_cast<std::size_t>(asset_.width) * static_cast<std::size_t>(asset_.height);
  std::vector<float> folded = vectors(channels.cast<float>(), places);
  PrtAsset result = asset_;
  result.channels = static_cast<int>(channels.rows());
  result.spectrum.reset();
  result.pca.reset();
  result.clusters.reset();
  if (asset_.is_per_vertex()) {
    result.planes.resize(result.vector_length());
    result.vertex_transfer = std::move(folded);
  } else {
    put_planes(result, folded);
  }
  return result;
}

}  // namespace kiln
