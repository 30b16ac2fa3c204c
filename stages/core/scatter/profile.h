#pragma once

namespace kiln {

/// How light that enters a flat half space at one point leaves it around that point, as a function of the distance r in
/// millimetres: R(r), exitance per irradiance and mm^2. Holds no tables and never overflows: any coefficients that the
/// factories take give finite values for any r >= 0, but R itself, which is infinite at 0 in the limits.
class ScatterProfile {
 public:
  /// The dipole diffusion approximation (Jensen et al. 2001, equations 4 and 5; internal reflection by Groenhuis et al.
  /// as there, Fdr(eta)). Reduced scattering and absorption in 1/mm, not both zero; eta >= 1. Fresnel factors on entry
  /// and exit are left at 1: what the surface mirrors is not in it.
  static ScatterProfile dipole(double scattering_per_mm, double absorption_per_mm, double eta);

  /// Normalised diffusion (Christensen and Burley, "Approximate reflectance profiles for efficient subsurface
  /// scattering", 2015): A s (e^-sr + e^-sr/3) / (8 pi r), r in mean free paths, with their fit
  /// s = 1.9 - A + 3.5 (A - 0.8)^2 for light that enters diffusely. Surface albedo A of 0 to 1; mean free path in mm,
  /// above 0.
  static ScatterProfile diffusion(double surface_albedo, double mean_free_path_mm);

  /// R(r), 1/mm^2; very large but finite at r = 0.
  double density(double r_mm) const;

  /// The integral of R over the disc of radius r: 0 at 0, nearing total() as r (finite) grows. Keeps its
  /// relative accuracy for small r.
  double within(double r_mm) const;

  /// Total diffuse reflectance of the half space, 0 to 1: the integral of R over the plane.
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
