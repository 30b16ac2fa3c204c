// SPDX-License-Identifier: MIT
#pragma once

namespace kiln {

/// Ways to spread directions over the sphere; each direction stands for the solid angle 4 pi / count.
enum class Sampling {
  fibonacci,    ///< spherical Fibonacci points [Keinert 2015], the whole set rotated at random
  stratified,   ///< one jittered point per cell of a unit square, mapped to the sphere with equal areas
                ///< ([US 7,948,490], [Chapter 2010])
  progressive,  ///< the first `count` of progressive_directions
};

}  // namespace kiln
