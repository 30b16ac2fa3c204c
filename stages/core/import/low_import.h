// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "base/json_fwd.h"
#include "import/import_settings.h"

namespace kiln {

/// Axis, unit and factor of the file of an artist's low mesh, as `--up`, `--unit` and `--scale` have them for the high
/// one; "same": those of the high mesh.
struct LowPlacement {
  std::string up = "same", unit = "same", scale = "same";
};

/// Returns how the file of a low mesh is read: as the high mesh, but for its placement, and no hole of it is filled.
/// Throws WrongUsage for words that are none.
ImportSettings low_import_settings(const ImportSettings& high, const LowPlacement& placement);

/// Returns that of the settings which a record of kiln-simplify holds.
ImportSettings low_import_settings_of(const Json& recorded);

}  // namespace kiln
