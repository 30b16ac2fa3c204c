// SPDX-License-Identifier: MIT
#include "kiln/asset.h"

#include <string>
#include <utility>

#include "api/report_errors.h"
#include "asset/prt_asset.h"

namespace kiln::runtime {

Error::~Error() = default;

namespace {

static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float) && sizeof(Eigen::Vector2f) == 2 * sizeof(float));

template <class Vector>
std::span<const float> numbers_of(const std::vector<Vector>& vectors) {
  if (vectors.empty()) return {};
  return {vectors.front().data(), vectors.size() * static_cast<std::size_t>(Vector::RowsAtCompileTime)};
}

}  // namespace

Asset::Asset(std::shared_ptr<const PrtAsset> asset) : asset_(std::move(asset)) {}

Asset Asset::load(const std::filesystem::path& folder) {
  return report_errors([&] { return Asset(std::make_shared<const PrtAsset>(load_prt_asset(folder))); });
}

Form Asset::form() const {
  if (asset_->is_per_vertex()) return Form::vertices;
  return asset_->clusters ? Form::clusters : Form::texels;
}

int Asset::bands() const { return asset_->bands; }
int Asset::channels() const { return asset_->channels; }
int Asset::width() const { return asset_->width; }
int Asset::height() const { return asset_->height; }

std::size_t Asset::points() const {
  if (form() == Form::vertices) return asset_->mesh.positions.size();
  return static_cast<std::size_t>(asset_->width) * static_cast<std::size_t>(asset_->height);
}

std::size_t Asset::vector_length() const { return asset_->vector_length(); }

std::span<const float> Asset::positions() const { return numbers_of(asset_->mesh.positions); }
std::span<const float> Asset::normals() const { return numbers_of(asset_->mesh.normals); }
std::span<const float> Asset::uvs() const { return numbers_of(asset_->mesh.uvs); }
std::span<const float> Asset::texture_uvs() const { return numbers_of(asset_->mesh.texture_uvs); }

std::span<const std::uint32_t> Asset::triangles() const {
  if (asset_->mesh.triangles.empty()) return {};
  return {asset_->mesh.triangles.front().data(), 3 * asset_->mesh.triangles.size()};
}

std::array<double, 3> Asset::origin() const { return {asset_->origin.x(), asset_->origin.y(), asset_->origin.z()}; }

void Asset::transfer(std::span<const std::uint32_t> points, std::span<float> vectors) const {
  const std::size_t count = this->points(), length = vector_length();
  if (vectors.size() < points.size() * length)
    throw Error("Asset::transfer: found room for " + std::to_string(vectors.size()) + " numbers; expected " +
                std::to_string(points.size() * length));
  for (const std::uint32_t point : points)
    if (point >= count)
      throw Error("Asset::transfer: found point " + std::to_string(point) + "; expected less than " +
                  std::to_string(count));
  if (form() != Form::vertices) {
    decode_transfer(*asset_, points, vectors);
    return;
  }
  for (std::size_t k = 0; k < points.size(); ++k)
    std::copy_n(asset_->vertex_transfer.data() + points[k] * length, length, vectors.data() + k * length);
}

bool Asset::knows_albedo() const { return asset_->albedo.known; }

Color Asset::albedo(std::uint32_t point) const {
  if (point >= points())
    throw Error("Asset::albedo: found point " + std::to_string(point) + "; expected less than " +
                std::to_string(points()));
  const Eigen::Vector3f albedo = asset_->albedo.at(point);
  return {albedo.x(), albedo.y(), albedo.z()};
}

std::span<const std::uint8_t> Asset::opacity() const { return asset_->opacity.values(); }
int Asset::opacity_width() const { return asset_->opacity.width(); }
int Asset::opacity_height() const { return asset_->opacity.height(); }

}  // namespace kiln::runtime
