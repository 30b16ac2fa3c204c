// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "base/json_fwd.h"
#include "spectrum/basis.h"
#include "spectrum/sensor.h"

namespace kiln {

/// Returns a basis as docs/schema/spectrum.schema.json describes it: its wavelengths and functions, light vectors and
/// surface matrices of a scene, the matrices of sensors, and as
/// many wavelengths (find_wavelengths, at least three).
Json basis_json(const SpectralScene& scene, const SpectralBasis& basis, const std::vector<LightSensor>& sensors);

}  // namespace kiln
