// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/wavelength_albedo.h"

#include <algorithm>
#include <stdexcept>

#include "spectrum/standards.h"

namespace kiln {

namespace {

/// Nodes of the table along each of red, green and blue.
constexpr int table_side = 25;

}  // namespace

WavelengthAlbedo::WavelengthAlbedo(std::vector<int> wavelengths_nm)
    : wavelengths_(std::move(wavelengths_nm)), lift_(StandardSpectra()) {
  for (const int nm : wavelengths_)
    if (nm < first_wavelength_nm || nm >= first_wavelength_nm + wavelength_count)
      throw std::invalid_argument("WavelengthAlbedo: wavelengths of spectra are needed");
}

std::vector<float> WavelengthAlbedo::of(const Spectrum& reflectance) const {
  std::vector<float> shares;
  for (const int nm : wavelengths_) shares.push_back(static_cast<float>(reflectance(nm - first_wavelength_nm)));
  return shares;
}

std::vector<float> WavelengthAlbedo::of(const Eigen::Vector3f& albedo) const {
  const SmoothReflectance lifted = lift_.lift(albedo.cast<double>());
  std::vector<float> shares;
  for (const int nm : wavelengths_) shares.push_back(static_cast<float>(lifted.at(nm)));
  return shares;
}

void WavelengthAlbedo::prepare_table() {
  if (!table_.is_empty()) return;
  table_ = AlbedoTable(table_side, size(), [&](const Eigen::Vector3d& albedo, std::span<float> shares) {
    std::ranges::copy(of(Eigen::Vector3f(albedo.cast<float>())), shares.begin());
  });
}

SceneReflectance::SceneReflectance(const SceneMesh& scene, std::vector<int> wavelengths_nm)
    : albedo_(std::move(wavelengths_nm)) {
  bool needs_table = false;
  for (const SurfaceAlbedo& albedo : scene.albedos) {
    std::vector<std::vector<float>>& constants = constants_.emplace_back();
    for (const SurfaceAlbedo::Material& material : albedo.materials()) {
      std::vector<float>& constant = constants.emplace_back();
      if (material.measured.spectrum != nullptr)
        constant = albedo_.of(*material.measured.spectrum);
      else if (material.texture == nullptr)
        constant = albedo_.of(material.color);
      needs_table = needs_table || constant.empty();
    }
    if (!constants.empty()) continue;
    std::vector<float>& constant = constants.emplace_back();
    if (albedo.reflectance() != nullptr)
      constant = albedo_.of(*albedo.reflectance());
    else if (albedo.is_constant())
      constant = albedo_.of(albedo.constant_value());
    needs_table = needs_table || constant.empty();
  }
  if (needs_table) albedo_.prepare_table();
}

const std::vector<float>& SceneReflectance::constant_at(const SceneMesh& scene, std::size_t part,
                                                        std::uint32_t triangle) const {
  const SurfaceAlbedo& albedo = scene.albedos[part];
  return constants_[part][albedo.materials().empty() ? 0 : albedo.material_at(triangle - scene.first_triangles[part])];
}

Eigen::Vector3f SceneReflectance::at(const SceneMesh& scene, std::uint32_t triangle, float u, float v,
                                     std::size_t first) const {
  std::vector<float> shares = constant_at(scene, scene.part_of(triangle), triangle);
  if (shares.empty()) {
    shares.resize(wavelengths());
    albedo_.look_up(scene.albedo_at(triangle, u, v), shares);
  }
  const std::size_t last = wavelengths() - 1;
  return {shares[std::min(first, last)], shares[std::min(first + 1, last)], shares[std::min(first + 2, last)]};
}

}  // namespace kiln
