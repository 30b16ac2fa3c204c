// SPDX-License-Identifier: GPL-3.0-or-later
#include "compress/transfer_source.h"

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "compress/chunks.h"
#include "mesh/uv_raster.h"
#include "sh/basis.h"
#include "sh/light_prior.h"

namespace kiln {

namespace {

constexpr std::size_t most_known_bytes = std::size_t{128} << 20;

std::vector<std::uint8_t> coverage_of_mesh(const PrtAsset& asset) {
  const UvRaster raster = rasterise_uvs(asset.mesh, asset.width, asset.height);
  std::vector<std::uint8_t> coverage(raster.texels.size());
  std::transform(raster.texels.begin(), raster.texels.end(), coverage.begin(),
                 [](const TexelSource& source) { return static_cast<std::uint8_t>(source.covered()); });
  return coverage;
}

}  // namespace

TransferSource::TransferSource(const PrtAsset& asset) : TransferSource(asset, coverage_of_mesh(asset)) {}

TransferSource::TransferSource(const PrtAsset& asset, std::vector<std::uint8_t> coverage)
    : asset_(asset), coverage_(std::move(coverage)) {
  const std::vector<double> prior = lighting_prior(asset.bands);
  const int coefficients = asset.bands * asset.bands;
  scale_.resize(asset.channels * coefficients);
  for (int i = 0; i < scale_.size(); ++i) scale_[i] = static_cast<float>(std::sqrt(prior[band_of(i % coefficients)]));
  for (std::size_t texel = 0; texel < coverage_.size(); ++texel)
    if (coverage_[texel] != 0) covered_.push_back(static_cast<std::uint32_t>(texel));
  if (covered_.empty())
    throw BadInput(asset.ranges_file.string(), "has a mesh that covers no texel", "an atlas packed for this size",
                   "bake the asset again");
  remember();
  squared_norm_ = sum_of_chunks(covered_.size(), [&](std::size_t first, std::size_t count) {
    return vectors(std::span(covered_).subspan(first, count)).cast<double>().squaredNorm();
  });
}

std::vector<std::uint32_t> TransferSource::sample(std::size_t most) const {
  const std::size_t count = std::min(most, covered_.size());
  std::vector<std::uint32_t> texels(count);
  for (std::size_t k = 0; k < count; ++k) texels[k] = covered_[k * covered_.size() / count];
  return texels;
}

void TransferSource::remember() {
  if (covered_.size() * static_cast<std::size_t>(length()) * sizeof(float) > most_known_bytes) return;
  Eigen::MatrixXf all(length(), static_cast<Eigen::Index>(covered_.size()));
  for_each_chunk(covered_.size(), [&](std::size_t first, std::size_t count) {
    all.middleCols(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(count)) =
        decoded(std::span(covered_).subspan(first, count));
  });
  places_.resize(coverage_.size());
  for (std::size_t k = 0; k < covered_.size(); ++k) places_[covered_[k]] = static_cast<std::uint32_t>(k);
  known_ = std::move(all);
}

Eigen::MatrixXf TransferSource::vectors(std::span<const std::uint32_t> texels) const {
  const auto is_known = [&](std::uint32_t texel) { return coverage_[texel] != 0; };
  if (known_.size() == 0 || !std::all_of(texels.begin(), texels.end(), is_known)) return decoded(texels);
  Eigen::MatrixXf result(length(), static_cast<Eigen::Index>(texels.size()));
  for (std::size_t k = 0; k < texels.size(); ++k)
    result.col(static_cast<Eigen::Index>(k)) = known_.col(places_[texels[k]]);
  return result;
}

Eigen::MatrixXf TransferSource::decoded(std::span<const std::uint32_t> texels) const {
  Eigen::MatrixXf result(length(), static_cast<Eigen::Index>(texels.size()));
  decode_transfer(asset_, texels, std::span(result.data(), static_cast<std::size_t>(result.size())));
  result.array().colwise() *= scale_.array();
  return result;
}

}  // namespace kiln
