// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/unit_frame.h"

namespace kiln {

UnitFrame::UnitFrame(const TriangleMesh& mesh) {
  const BoundingBox box = bounding_box(mesh);
  centre = box.centre().cast<double>();
  diagonal = (box.highest - box.lowest).cast<double>().norm();
}

}  // namespace kiln
