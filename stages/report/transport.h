// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "base/json_fwd.h"

namespace kiln {

/// Tells whether an asset's transfer, by its record of the bake, includes more than direct light.
bool scatters_light(const Json& bake);

/// Returns how often light bounced in a bake.
std::size_t bounces_taken(const Json& bake);

/// Makes the section on direct light, every bounce and subsurface scattering: energy and time. HTML; empty where there
/// is only direct light.
std::string transport_section(const Json& bake);

}  // namespace kiln
