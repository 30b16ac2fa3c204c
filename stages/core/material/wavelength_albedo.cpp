// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/wavelength_albedo.h"

#include <algorithm>
#include <stdexcept>

#include "base/parallel.h"
#include "image/srgb.h"
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
  if (!table_.empty()) return;
  table_.resize(table_side * table_side * table_side * size());
  parallel_for(0, table_side * table_side, [&](int row) {
    for (int i = 0; i < table_side; ++i) {
      const Eigen::Vector3i node(i, row % table_side, row / table_side);
      const Eigen::Vector3f encoded = node.cast<float>() / (table_side - 1);
      const std::vector<float> shares = of(Eigen::Vector3f(encoded.unaryExpr(&linear_from_srgb)));
      std::ranges::copy(shares, table_.begin() + static_cast<std::ptrdiff_t>(
                                                     (static_cast<std::size_t>(row) * table_side + i) * size()));
    }
  });
}

void WavelengthAlbedo::look_up(const Eigen::Vector3f& albedo, std::span<float> shares) const {
  const Eigen::Vector3f place = albedo.unaryExpr(&srgb_from_linear) * (table_side - 1);
  const Eigen::Vector3i low = place.cast<int>().cwiseMin(table_side - 2).cwiseMax(0);
  const Eigen::Vector3f share = place - low.cast<float>();
  std::ranges::fill(shares, 0.f);
  for (int corner = 0; corner < 8; ++corner) {
    std::size_t node = 0, stride = 1;
    float weight = 1;
    for (int c = 0; c < 3; ++c, stride *= table_side) {
      const int up = corner >> c & 1;
      node += stride * static_cast<std::size_t>(low(c) + up);
      weight *= up != 0 ? share(c) : 1 - share(c);
    }
    for (std::size_t k = 0; k < shares.size(); ++k) shares[k] += weight * table_[node * size() + k];
  }
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
