// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/json_fwd.h"
#include "spectrum/spectral_error.h"
#include "spectrum/spectrum_settings.h"

namespace kiln {

/// Errors of one way to compute colours, in direct light and after several reflections.
struct ComparedColors {
  std::string name = {};  ///< "RGB", "lifted" or a kind of basis
  int size = 0;           ///< functions of a basis
  ColorErrors direct = {};
  ColorErrors reflected = {};
};

/// RGB against bases of 3 to 8 functions for a scene, and of up to 16 where 8 do not do.
struct SpectrumReport {
  ComparedColors rgb = {};
  ComparedColors lifted = {};
  std::vector<ComparedColors> bases = {};
  std::vector<ComparedColors> wavelengths = {};  ///< chosen ones, 3 to 8, each a channel that bounces by itself
  /// Least functions within the error, 0 where RGB is; nothing where none of `bases` is.
  std::optional<int> least_direct = {};
  std::optional<int> least_reflected = {};
  std::size_t chains = 0;  ///< combinations of surfaces compared after several reflections
};

/// Reads what the settings name. Throws WrongUsage, BadInput.
SpectralScene spectral_scene(const StandardSpectra& standards, const SpectrumSettings& settings);

/// Returns the basis of that many functions, or of as many as the scene has; the lights as basis have their own number.
SpectralBasis basis_of(const BasisFinder& finder, BasisKind kind, int size);

/// Compares RGB, albedos lifted to spectra, and bases with the truth.
SpectrumReport compare_colors(const StandardSpectra& standards, const SpectralScene& scene, const BasisFinder& finder,
                              const SpectrumSettings& settings);

/// Returns the report for --json, and as a table.
Json to_json(const SpectrumReport& report, const SpectralScene& scene);
std::string to_text(const SpectrumReport& report, const SpectralScene& scene, const SpectrumSettings& settings);

}  // namespace kiln
