// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "atlas/chart.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Variation of transfer over each chart, and the charts' sizes that follow.
struct ChartDensities {
  std::vector<double> scales;  ///< per chart: texels per unit relative to the mean; area times squares sum to area
  std::vector<double> errors;  ///< per chart: mean squared error of interpolating transfer over `spacing`
  double spacing = 0;          ///< object units
  double order = 0;            ///< the power of the spacing that the squared error grows with, over all charts
};

struct DensitySettings {
  int samples = 20000;   ///< number of sample points on the surface, roughly
  int directions = 256;  ///< directions of the transfer at each sample
  int bands = 3;
  double least_scale = 0.5;  ///< smallest scale of a chart relative to the mean
  double most_scale = 2;
};

/// Finds scales that minimise the error of transfer in an atlas of a given number of texels. Transfer sampled with
/// spacing h and looked up linearly has a mean squared error e_c = a_c h^p on chart c, and a chart of area A_c takes
/// A_c / h^2 texels. The sum of A_c e_c at a fixed number of texels is least where h_c^(p + 2) a_c is the same for all
/// charts ([Sander 2002] has p = 2, for constant texels). a_c is measured: transfer is computed on a grid over each
/// chart, and each point compared with the mean of its two neighbours. p is measured by leaving out every other point.
/// Transfer is that of the nearest points of `high` that face the same way, with its normals and shadows; without
/// `high` (null), the surface's own. The charts' uvs must have the surface's area.
ChartDensities densities_by_transfer(const Surface& surface, const std::vector<Chart>& charts, const TriangleMesh* high,
                                     const DensitySettings& settings = {});

/// Resizes the charts by these scales.
void scale_charts(std::vector<Chart>& charts, const std::vector<double>& scales);

}  // namespace kiln
