// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sh/sampling.h"

namespace kiln {

/// Returns `count` >= 1 unit vectors; the same for the same arguments on any machine.
std::vector<Eigen::Vector3f> sample_directions(Sampling sampling, int count, std::uint64_t seed);

/// Returns the least number of directions over which sums keep the basis functions of so many bands apart: products of
/// two of them, whose orders add up to 2 bands - 2, are integrated with an error below a tenth. With fewer, transfer
/// coefficients leak into each other, which no later step undoes.
///
/// Measured: the largest eigenvalue of 4 pi / count B B' - 1, with B the basis at the directions, for 3 to 16 bands. It
/// depends on count / bands^2 alone, within a factor of two. Fibonacci: 1.0 at 1, 0.20 at 2, 0.08 at 3, 0.05 at 4, 0.02
/// at 6, 0.005 at 16; so 4 bands^2, which is (2 bands)^2. Progressive: 0.3 to 0.8 at 2, 0.28 at 4, 0.15 at 8, 0.11 at
/// 16; so 16 bands^2. Stratified, as one over the square root: 1.1 at 2, 0.7 at 4, 0.4 at 8, 0.3 at 16, 0.11 at 32; so
/// 32 bands^2.
std::int64_t directions_for_bands(Sampling sampling, int bands);

/// Returns directions `first` to `first` + `count` - 1 of an endless sequence of unit vectors, every prefix of which is
/// spread nearly as well as a Fibonacci set of its size. `first` >= 0; `count` >= 0. Element i depends on i and the
/// seed alone, so the sequence may be cut into any batches. Arithmetic is in integers up to the sine and cosine, so two
/// machines differ at most by the rounding of libm and the compiler.
///
/// Source: an extensible rank-1 lattice [Hickernell 2000]: frac(phi(i) (1, a)) with phi the radical inverse in base 2,
/// mapped to the sphere with equal areas (the height first) and rotated at random as a whole. The first 2^m are a
/// lattice, and those after them a shifted copy, up to 2^30 directions. Properties, over prefixes of 64 to 2,097,152
/// directions, 36 coefficients of clamped cosine times visibility, where one to three caps of 10 to 50 degrees block:
/// - its relative error is 1.2 times that of the Fibonacci set of the same size: 1.0 to 1.25 times at powers of two, at
///   most 1.4 times at any multiple of 32; it falls as count^-3/4, as Fibonacci's does. Stratified jitter has 1.7 (at a
///   million) to 3.3 times (at 64) Fibonacci's error.
/// - Half the distance between the mean of the first half and that of the second is 1.5 times the error of the whole
///   (1.1 to 2.0): the halves err in opposite directions, so this estimate is on the safe side.
std::vector<Eigen::Vector3f> progressive_directions(std::int64_t first, int count, std::uint64_t seed);

/// Reorders unit vectors so that each consecutive `block` >= 1 of them, counted from the first (the last may have
/// fewer), is a compact patch: the sphere is cut into two caps and collars of nearly square patches (after [Leopardi
/// 2006]), by rank, so that patches follow the density of the directions. Meant for sets that cover the sphere about
/// evenly; of any set it gives a deterministic permutation.
void order_coherently(std::vector<Eigen::Vector3f>& directions, int block = 32);

/// Returns the unit vector of an azimuth (0 is +Z, 90 is +X) and an elevation above the horizon (90 is +Y).
Eigen::Vector3f direction_from_angles(double azimuth_degrees, double elevation_degrees);

}  // namespace kiln
