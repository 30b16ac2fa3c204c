// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "asset/prt_asset.h"

namespace kiln {

/// Reads the wavelengths that kiln-spectrum chose for bounced light, and the matrices that read them under its lamps,
/// from a basis file. Throws BadInput.
PrtSpectrum read_spectral_channels(const std::filesystem::path& file);

}  // namespace kiln
