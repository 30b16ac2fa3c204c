// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/measured_reflectance.h"

#include "base/errors.h"
#include "spectrum/rgb_lift.h"
#include "spectrum/standards.h"

namespace kiln {

MeasuredReflectance load_reflectance(const std::string& reflectance) {
  const StandardSpectra standards;
  MeasuredReflectance loaded;
  loaded.spectrum = standards.reflectance(reflectance);
  const Eigen::Vector3d color = RgbLift(standards).albedo_of(loaded.spectrum.values);
  constexpr double rounding = 1e-6;
  loaded.is_clamped = color.minCoeff() < -rounding || color.maxCoeff() > 1 + rounding;
  loaded.albedo = color.cwiseMax(0).cwiseMin(1).cast<float>();
  if (std::error_code error; std::filesystem::is_regular_file(reflectance, error)) loaded.files = {reflectance};
  return loaded;
}

std::map<std::string, MeasuredReflectance> load_reflectances_of(const MaterialSettings& settings) {
  std::map<std::string, MeasuredReflectance> loaded;
  for (const auto& [material, reflectance] : reflectances_of_materials(settings.reflectance_of))
    loaded.emplace(material, load_reflectance(reflectance));
  return loaded;
}

std::optional<Eigen::Vector3f> constant_albedo(const MaterialSettings& settings) {
  if (settings.albedo) return Eigen::Vector3f(settings.albedo->data());
  if (!settings.reflectance.empty()) return load_reflectance(settings.reflectance).albedo;
  return std::nullopt;
}

}  // namespace kiln
