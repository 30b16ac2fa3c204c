#pragma once

#include <string>

#include "base/options.h"

namespace kiln {

/// Whether an asset's transfer, by its record of the bake, has more than direct light in it.
bool scatters_light(const Json& bake);

/// Direct light, every bounce and what scatters beneath the surface: energy and time. HTML; empty where there is only
/// direct light.
std::string transport_section(const Json& bake);

}  // namespace kiln
