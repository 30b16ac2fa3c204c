// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "base/json_fwd.h"
#include "spectrum/basis.h"
#include "spectrum/sensor.h"

namespace kiln {

/// Returns a basis as docs/schema/spectrum.schema.json describes it: its wavelengths and functions, light vectors and
/// surface matrices of a scene, and the matrices of sensors.
Json basis_json(const SpectralScene& scene, const SpectralBasis& basis, const std::vector<LightSensor>& sensors);

}  // namespace kiln
