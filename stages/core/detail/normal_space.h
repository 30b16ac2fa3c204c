#pragma once

namespace kiln {

/// The space of a normal map's vectors: the object's, or that of the low mesh's MikkTSpace frames, whose green points
/// along +v.
enum class NormalSpace { object, tangent };

}  // namespace kiln
