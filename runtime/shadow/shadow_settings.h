// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace kiln {

/// Ways to find the light that the other nodes of a scene leave to a node.
enum class ShadowMethod {
  none,            ///< all of it
  thesis,          ///< filters that pass down the tree, and Hann-weighted products ([Chapter 2010], 5.1.6 and 5.1.7)
  product,         ///< the same filters, plain products (5.1.7)
  subtraction,     ///< the same filters, what they lack of one taken from the light (5.1.7)
  exponentiation,  ///< logarithms of the visibility of spheres, summed [Ren 2006]
  fields,          ///< visibility on shells around an object, looked up [Zhou 2005]
  combined,        ///< visibility of all nodes together, multiplied with the light itself before it is projected
};

/// Names of the methods, in the order of the enumerators.
inline constexpr std::array<std::string_view, 7> shadow_method_names = {
    "none", "thesis", "product", "subtraction", "exponentiation", "fields", "combined"};

/// Ways in which `combined` finds which directions are blocked.
enum class ShadowBackend {
  rays,  ///< of Embree, on the CPU
  gpu,   ///< maps drawn at the points (runtime/shadow_gl)
};

/// Names of the ways, in the order of the enumerators.
inline constexpr std::array<std::string_view, 2> shadow_backend_names = {"rays", "gpu"};

struct ShadowSettings {
  ShadowMethod method = ShadowMethod::combined;

  /// Directions of the sphere around a sample point: rays of `thesis`, `product` and `subtraction`, and of the sky by
  /// `combined`, which takes as many again for each light that covers an angle. 1 or more.
  int directions = 1024;
  int threads = 0;  ///< 0: all

  /// Bands of the light and the filter that `product` multiplies, up to 19; 0: those of the transfer. 2n - 1 keep what
  /// the first n of the product need of either.
  int product_bands = 0;

  /// Whether the filters of trees see composite nodes as balls, the thesis's fast way (5.3), not by their meshes.
  bool composite_balls = false;

  /// Half-angle of the bounding cone below which `combined` lets a node be a cap before the sky, without rays.
  double cap_degrees = 1.5;

  int spheres = 32;  ///< that stand for a mesh in `exponentiation`; 1 or more
};

/// What an update did.
struct ShadowStatistics {
  std::size_t computed = 0;  ///< filters: one node's at one of its points
  std::size_t kept = 0;      ///< filters of mesh nodes that were right already
  std::size_t pairs = 0;     ///< nodes and occluders that may shadow them, of the computed ones
};

}  // namespace kiln
