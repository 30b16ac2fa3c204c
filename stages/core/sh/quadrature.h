// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace kiln {

/// Node of a quadrature rule on [-1, 1] and its weight.
struct LineNode {
  double place, weight;
};

/// Returns the Gauss-Legendre rule of `count` >= 1 nodes, exact for polynomials up to degree 2 count - 1.
std::vector<LineNode> gauss_legendre(int count);

/// Quadrature rule on the sphere: directions and their weights.
struct SphereQuadrature {
  std::vector<Eigen::Vector3d> directions;
  std::vector<double> weights;  ///< steradians; together 4 pi
};

/// Returns a product rule (Gauss-Legendre nodes in z, even azimuths) that integrates every polynomial up to `degree`
/// exactly, hence products of spherical harmonics whose orders add up to no more ([Atkinson 2012], section 5.1).
/// `degree` of 0 to 1,000.
SphereQuadrature exact_quadrature(int degree);

}  // namespace kiln
