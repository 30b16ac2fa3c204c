#pragma once

#include <Eigen/Core>
#include <vector>

namespace kiln {

/// A place on [-1, 1] and what it stands for.
struct LineNode {
  double place, weight;
};

/// `count` >= 1 nodes with which sums over [-1, 1] are integrals, of polynomials up to degree 2 count - 1 exactly.
std::vector<LineNode> gauss_legendre(int count);

/// Directions and weights with which sums over the sphere are integrals.
struct SphereQuadrature {
  std::vector<Eigen::Vector3d> directions;
  std::vector<double> weights;  ///< steradians; together 4 pi
};

/// A product of Gauss-Legendre nodes in z and even azimuths that integrates every polynomial up to `degree` exactly, so
/// products of spherical harmonics whose orders add up to no more (Atkinson and Han, "Spherical Harmonics and
/// Approximations on the Unit Sphere", 2012, section 5.1). `degree` of 0 to 1,000.
SphereQuadrature exact_quadrature(int degree);

}  // namespace kiln
