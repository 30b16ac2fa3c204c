#pragma once

#include <vector>

#include "atlas/chart.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// How much transfer varies over each chart, and what follows for the charts' sizes.
struct ChartDensities {
  std::vector<double>
      scales;  ///< per chart: its share of texels per unit over the mean; area times squares sum to area
  std::vector<double> errors;  ///< per chart: mean squared error of interpolating transfer over `spacing`
  double spacing = 0;          ///< object units
  double order = 0;            ///< the power of the spacing that the squared error grows with, over all charts
};

struct DensitySettings {
  int samples = 20000;   ///< points of the surface, about
  int directions = 256;  ///< of the transfer at each
  int bands = 3;
  double least_scale = 0.5;  ///< of a chart over the mean
  double most_scale = 2;
};

/// Scales that make the error of transfer in an atlas of a given number of texels least. Where transfer is sampled
/// with a spacing h and looked up linearly, its mean squared error on chart c is e_c = a_c h^p; texels number A_c / h^2
/// over a chart of area A_c. The least sum of A_c e_c at a fixed sum of texels has h_c^(p + 2) a_c the same for all
/// charts (Sander, Gortler, Snyder and Hoppe, "Signal-specialized parameterization", 2002, have p = 2, for constant
/// texels). a_c is measured: transfer is taken on a grid over each chart, and each point compared with the mean of its
/// two neighbours; p too, by leaving out every other point. Transfer is that of the nearest points of `high` that face
/// the same way, with its normals and its shadows; without it (null), the surface's own. The charts' uvs are as large
/// as the surface.
ChartDensities densities_by_transfer(const Surface& surface, const std::vector<Chart>& charts, const TriangleMesh* high,
                                     const DensitySettings& settings = {});

/// Resizes the charts by these scales.
void scale_charts(std::vector<Chart>& charts, const std::vector<double>& scales);

}  // namespace kiln
