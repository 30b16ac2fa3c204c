#pragma once

#include <Eigen/Core>
#include <vector>

#include "atlas/chart.h"

namespace kiln {

/// CGAL's parameterisation of a chart, in units of its own; empty where CGAL reports an error. No promise that it is
/// valid.
std::vector<Eigen::Vector2d> cgal_parameterise(const Surface& surface, const Chart& chart, Parameteriser parameteriser);

}  // namespace kiln
