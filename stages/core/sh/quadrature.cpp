// SPDX-License-Identifier: MIT
#include "sh/quadrature.h"

#include <cassert>
#include <cmath>
#include <numbers>

namespace kiln {

namespace {

/// Computes node `index` of `count` on [-1, 1], by Newton's iteration on the Legendre polynomial.
LineNode line_node(int index, int count) {
  double z = std::cos(std::numbers::pi * (index + 0.75) / (count + 0.5)), derivative = 1;
  for (int step = 0; step < 100; ++step) {
    double before = 1, p = z;
    for (int l = 2; l <= count; ++l) {
      const double next = ((2 * l - 1) * z * p - (l - 1) * before) / l;
      before = p;
      p = next;
    }
    derivative = count * (z * p - before) / (z * z - 1);
    const double change = p / derivative;
    z -= change;
    if (std::abs(change) < 1e-15) break;
  }
  return {z, 2 / ((1 - z * z) * derivative * derivative)};
}

}  // namespace

std::vector<LineNode> gauss_legendre(int count) {
  std::vector<LineNode> nodes;
  for (int k = 0; k < count; ++k) nodes.push_back(line_node(k, count));
  return nodes;
}

SphereQuadrature exact_quadrature(int degree) {
  assert(degree >= 0 && degree <= 1000);
  const int nodes = degree / 2 + 1, azimuths = degree + 1;
  SphereQuadrature quadrature;
  for (const LineNode& node : gauss_legendre(nodes)) {
    const double radius = std::sqrt(1 - node.place * node.place);
    for (int a = 0; a < azimuths; ++a) {
      const double phi = 2 * std::numbers::pi * a / azimuths;
      quadrature.directions.emplace_back(radius * std::cos(phi), radius * std::sin(phi), node.place);
      quadrature.weights.push_back(node.weight * 2 * std::numbers::pi / azimuths);
    }
  }
  return quadrature;
}

}  // namespace kiln
