#pragma once

#include "base/options.h"

namespace kiln {

/// What orders the collapses, and where a collapsed edge's vertex goes.
enum class CollapseCost {
  lindstrom_turk,         ///< change of volume, boundary and shape; no memory of the original surface
  plane,                  ///< Garland-Heckbert quadrics of the faces' planes
  probabilistic_triangle  ///< Garland-Heckbert quadrics of triangles whose corners are uncertain
};

struct SimplifySettings {
  int faces = 1000;      ///< triangles to stop at, where max_error is 0
  double max_error = 0;  ///< Hausdorff distance to stop at, as a fraction of the bounding box's diagonal; 0: by faces
  CollapseCost cost = CollapseCost::lindstrom_turk;
};

OptionSet simplify_options(SimplifySettings& settings);

}  // namespace kiln
