#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace kiln {

/// How directions are spread over the sphere; each stands for the solid angle 4 pi / count.
enum class Sampling {
  fibonacci,   ///< spherical Fibonacci points (Keinert, Innmann, Saenger and Stamminger 2015), rotated at random as a
               ///< whole
  stratified,  ///< one jittered point in each cell of a unit square, mapped to the sphere with equal areas (the patent,
               ///< the thesis)
};

/// `count` >= 1 unit vectors; the same for the same arguments on any machine.
std::vector<Eigen::Vector3f> sample_directions(Sampling sampling, int count, std::uint64_t seed);

/// The unit vector of an azimuth (0 is +Z, 90 is +X) and an elevation above the horizon (90 is +Y).
Eigen::Vector3f direction_from_angles(double azimuth_degrees, double elevation_degrees);

}  // namespace kiln
