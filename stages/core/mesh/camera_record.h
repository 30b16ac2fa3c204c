// SPDX-License-Identifier: MIT
#pragma once

#include "base/json_fwd.h"
#include "mesh/camera.h"

namespace kiln {

/// Writes a camera as results have it: position, target and unit axes in object space, half the width and height of the
/// picture's plane at distance 1, the nearest and the farthest depth, and the rows of the matrix from object space to
/// GL clip space, for column vectors.
Json to_json(const Camera& camera);

/// Reads a camera that to_json wrote, to the bit. Throws what nlohmann::json throws for anything else.
Camera camera_of_json(const Json& json);

}  // namespace kiln
