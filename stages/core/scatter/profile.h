// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace kiln {

/// Reflectance profile R(r): how light that enters a flat half space at one point leaves it at the distance r in
/// millimetres around that point; exitance per irradiance and mm^2. Holds no tables and never overflows: for any
/// coefficients that the factories accept, all values are finite for any r >= 0, except that R itself is infinite at 0
/// in the limits.
class ScatterProfile {
 public:
  /// Returns the dipole diffusion approximation ([Jensen 2001], equations 4 and 5, with its Fdr(eta) for internal
  /// reflection [Groenhuis 1983]). Reduced scattering and absorption in 1/mm, not both zero; eta >= 1. Fresnel factors
  /// on entry and exit are left at 1: mirror reflection of the surface is not included.
  static ScatterProfile dipole(double scattering_per_mm, double absorption_per_mm, double eta);

  /// Returns normalised diffusion [Christensen 2015]: A s (e^-sr + e^-sr/3) / (8 pi r), r in mean free paths, with the
  /// paper's fit s = 1.9 - A + 3.5 (A - 0.8)^2 for light that enters diffusely. Surface albedo A of 0 to 1; mean free
  /// path in mm, above 0.
  static ScatterProfile diffusion(double surface_albedo, double mean_free_path_mm);

  /// Returns R(r), 1/mm^2; very large but finite at r = 0.
  double density(double r_mm) const;

  /// Integrates R over the disc of radius r: 0 at 0, approaching total() as r (finite) grows. Keeps its relative
  /// accuracy for small r.
  double within(double r_mm) const;

  /// Returns the total diffuse reflectance of the half space, 0 to 1: the integral of R over the plane.
  double total() const;

  bool operator==(const ScatterProfile&) const = default;

 private:
  enum class Model { dipole, diffusion };
  Model model_ = Model::dipole;
  double albedo_ = 0;         // reduced albedo alpha', or surface albedo
  double attenuation_ = 0;    // effective transport coefficient sigma_tr, or s over the mean free path; 1/mm
  double depth_[2] = {0, 0};  // of the real and above the virtual source, mm (dipole)
};

}  // namespace kiln
