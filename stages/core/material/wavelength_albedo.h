// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "material/albedo_table.h"
#include "material/scene_mesh.h"
#include "spectrum/rgb_lift.h"
#include "spectrum/spectrum.h"

namespace kiln {

/// Reflectances at a few wavelengths: of measured surfaces as measured, of albedos as they are lifted (RgbLift).
class WavelengthAlbedo {
 public:
  /// Wavelengths in nm, within those of spectra. Throws MachineLacks where the CIE's spectra are not there.
  explicit WavelengthAlbedo(std::vector<int> wavelengths_nm);

  std::size_t size() const { return wavelengths_.size(); }

  std::vector<float> of(const Spectrum& reflectance) const;
  std::vector<float> of(const Eigen::Vector3f& albedo) const;

  /// Lifts albedos at the nodes of a table, once, which look_up needs.
  void prepare_table();

  /// Interpolates between the table's nodes, which stand evenly in sRGB's encoding: one share for each wavelength.
  void look_up(const Eigen::Vector3f& albedo, std::span<float> shares) const { table_.look_up(albedo, shares); }

 private:
  std::vector<int> wavelengths_;
  RgbLift lift_;
  AlbedoTable table_;
};

/// Reflectances at a few wavelengths of the meshes of a scene, each of which has an albedo.
class SceneReflectance {
 public:
  /// Throws MachineLacks.
  SceneReflectance(const SceneMesh& scene, std::vector<int> wavelengths_nm);

  std::size_t wavelengths() const { return albedo_.size(); }

  /// Returns the reflectances at wavelengths `first`, `first` + 1 and `first` + 2, of which those beyond the last are
  /// the last, at a point of a triangle of the scene given at first.
  Eigen::Vector3f at(const SceneMesh& scene, std::uint32_t triangle, float u, float v, std::size_t first) const;

 private:
  WavelengthAlbedo albedo_;
  const std::vector<float>& constant_at(const SceneMesh& scene, std::size_t part, std::uint32_t triangle) const;

  /// By mesh and material, of which a mesh without any has one; empty where the albedo differs from place to place.
  std::vector<std::vector<std::vector<float>>> constants_;
};

}  // namespace kiln
