// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "spectrum/spectrum.h"

namespace kiln {

/// What the values of a file stand for, which says what they may be.
enum class SpectrumKind {
  light,        ///< power per nm in any unit: 0 or more, and not 0 everywhere
  reflectance,  ///< 0 to 1
  response,     ///< of a sensor: 0 or more, and not 0 everywhere
  component     ///< of a sum: any finite value
};

/// Reads spectra as sampled. Two forms are told apart by their first word:
/// - text of numbers between commas, semicolons, tabs or blanks: a row per wavelength in nm, which rises, then a value
///   for each spectrum. '#' starts a comment; a first row of words names the columns.
/// - CGATS, as Argyll and colord write it (`SPECT`, `CMF`, `CTI3` or `CGATS.17` in front): a row per spectrum, fields
///   `SPEC_nnn`, or SPECTRAL_START_NM, SPECTRAL_END_NM and SPECTRAL_BANDS. Values are divided by SPECTRAL_NORM, those
///   of a .ti3 file by 100.
/// Samples span 400 to 700 nm at least and are at most 20 nm apart there. Throws BadInput for anything else: gaps,
/// disorder, values that `kind` does not allow, other units.
std::vector<SampledSpectrum> read_spectra(const std::filesystem::path& file, SpectrumKind kind);

/// Reads a file that holds one spectrum. Throws BadInput, also where it holds several.
SampledSpectrum read_spectrum(const std::filesystem::path& file, SpectrumKind kind);

}  // namespace kiln
