// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "atlas/chart.h"

namespace kiln {

/// Flattens a chart by CGAL, in CGAL's own units; empty where CGAL reports an error. The result may be invalid.
std::vector<Eigen::Vector2d> cgal_parameterise(const Surface& surface, const Chart& chart, Parameteriser parameteriser);

}  // namespace kiln
