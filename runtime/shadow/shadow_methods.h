// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <utility>

#include "runtime/shadow/moving_shadows.h"

namespace kiln {

/// Names of the methods, by which command lines and programs know them: the only list of them.
inline constexpr std::array shadow_method_names = {
    std::pair{"none", ShadowMethod::none},
};

}  // namespace kiln
