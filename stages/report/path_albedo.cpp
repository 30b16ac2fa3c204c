// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/path_albedo.h"

#include <algorithm>
#include <span>
#include <utility>

namespace kiln {

namespace {

PathShares shares_of(const std::vector<float>& numbers) {
  return Eigen::Map<const Eigen::ArrayXf>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

}  // namespace

PathShares shares_of(const Eigen::Vector3f& color) {
  PathShares shares(3);
  shares << color.x(), color.y(), color.z();
  return shares;
}

PathAlbedo::PathAlbedo(std::vector<SurfaceAlbedo> surfaces, const std::vector<int>& wavelengths_nm)
    : surfaces_(std::move(surfaces)) {
  if (wavelengths_nm.empty()) return;
  lift_.emplace(wavelengths_nm);
  const auto of_one = [&](const Spectrum* measured, bool is_one_color, const Eigen::Vector3f& color) {
    return measured != nullptr ? shares_of(lift_->of(*measured))
           : is_one_color      ? shares_of(lift_->of(color))
                               : PathShares();
  };
  for (const SurfaceAlbedo& surface : surfaces_) {
    std::vector<PathShares>& constants = constants_.emplace_back();
    if (surface.materials().empty())
      constants.push_back(of_one(surface.reflectance(), surface.is_constant(), surface.constant_value()));
    for (const SurfaceAlbedo::Material& material : surface.materials())
      constants.push_back(of_one(material.measured.spectrum.get(), material.texture == nullptr, material.color));
  }
  for (const std::vector<PathShares>& constants : constants_)
    if (std::ranges::any_of(constants, [](const PathShares& constant) { return constant.size() == 0; }))
      prepare_table();
}

void PathAlbedo::prepare_table() {
  if (lift_) lift_->prepare_table();
}

PathShares PathAlbedo::at(std::size_t surface, std::uint32_t triangle, float u, float v) const {
  if (const PathShares* const found = known(surface, triangle)) return *found;
  return of(surfaces_[surface].at(triangle, u, v));
}

PathShares PathAlbedo::lifted_at(std::size_t surface, std::uint32_t triangle, float u, float v) const {
  if (const PathShares* const found = known(surface, triangle)) return *found;
  const Eigen::Vector3f albedo = surfaces_[surface].at(triangle, u, v);
  return shares_of(lift_ ? lift_->of(albedo) : std::vector<float>(albedo.begin(), albedo.end()));
}

const PathShares* PathAlbedo::known(std::size_t surface, std::uint32_t triangle) const {
  if (!lift_) return nullptr;
  const SurfaceAlbedo& albedo = surfaces_[surface];
  const PathShares& constant = constants_[surface][albedo.materials().empty() ? 0 : albedo.material_at(triangle)];
  return constant.size() > 0 ? &constant : nullptr;
}

PathShares PathAlbedo::of(const Eigen::Vector3f& albedo) const {
  if (!lift_) return shares_of(albedo);
  PathShares shares(channels());
  lift_->look_up(albedo, std::span(shares.data(), static_cast<std::size_t>(shares.size())));
  return shares;
}

}  // namespace kiln
