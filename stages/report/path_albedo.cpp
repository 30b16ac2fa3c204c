// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/path_albedo.h"

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
  lift_->prepare_table();
  for (const SurfaceAlbedo& surface : surfaces_) {
    PathShares& constant = constants_.emplace_back();
    if (surface.reflectance() != nullptr)
      constant = shares_of(lift_->of(*surface.reflectance()));
    else if (surface.is_constant())
      constant = shares_of(lift_->of(surface.constant_value()));
  }
}

PathShares PathAlbedo::at(std::size_t surface, std::uint32_t triangle, float u, float v) const {
  if (const PathShares* const found = known(surface)) return *found;
  return of(surfaces_[surface].at(triangle, u, v));
}

PathShares PathAlbedo::lifted_at(std::size_t surface, std::uint32_t triangle, float u, float v) const {
  if (const PathShares* const found = known(surface)) return *found;
  const Eigen::Vector3f albedo = surfaces_[surface].at(triangle, u, v);
  return shares_of(lift_ ? lift_->of(albedo) : std::vector<float>(albedo.begin(), albedo.end()));
}

const PathShares* PathAlbedo::known(std::size_t surface) const {
  return lift_ && constants_[surface].size() > 0 ? &constants_[surface] : nullptr;
}

PathShares PathAlbedo::of(const Eigen::Vector3f& albedo) const {
  if (!lift_) return shares_of(albedo);
  PathShares shares(channels());
  lift_->look_up(albedo, std::span(shares.data(), static_cast<std::size_t>(shares.size())));
  return shares;
}

}  // namespace kiln
