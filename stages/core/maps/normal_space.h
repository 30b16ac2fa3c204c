// SPDX-License-Identifier: MIT
#pragma once

namespace kiln {

/// Space of a normal map's vectors: object space, or the low mesh's MikkTSpace frames (green points along +v).
enum class NormalSpace { object, tangent };

}  // namespace kiln
