// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace kiln {

/// Number of directions that a target error takes.
struct DirectionChoice {
  int directions = 0;
  double estimated_error = 0;  ///< error of integration alone, relative L2
  double target_error = 0;
};

/// Size of depth maps that the quantisation error takes.
struct ShadowSizeChoice {
  int size_texels = 0;
  double error = 0;      ///< error of visibility: relative L2 of transfer vectors to rays along the same directions
  double floor = 0;      ///< quantisation_floor at settings.bits
  bool reached = false;  ///< error <= floor; if no size does, the largest is taken
};

/// Result of baking some of the texels, for the record.
struct AdaptiveReport {
  double target = 0;
  /// Error of interpolation alone, relative L2 over all texels, measured at held-out texels that were baked after all.
  double error = 0;
  double error_of_interpolated = 0;  ///< the same over interpolated texels
  std::size_t held_out = 0;          ///< texels that it was measured at
  double bound = 0;                  ///< largest difference of a square's corners, over the rms length of vectors
  int rounds = 0;
  std::size_t baked = 0;         ///< texels that were baked
  std::size_t interpolated = 0;  ///< texels that were not
};

/// Result of bouncing, for the record.
struct BounceReport {
  std::size_t cache_points = 0;
  std::size_t cache_triangles = 0;
  double cache_seconds = 0;     ///< to cut the surface, and for the direct transfer of its points
  std::vector<double> energy;   ///< by bounce: ||t^b|| / ||t^0||, all channels, over a sample of receivers
  std::vector<double> seconds;  ///< by bounce; the last is that of the receivers themselves
  double floor = 0;             ///< with an automatic count: quantisation error, relative L2
  bool reached = true;          ///< whether an automatic count came under the floor
  std::string renderer;         ///< name of the engine that gathered
  std::size_t kept_bytes = 0;   ///< bytes of rays, by receivers and points together
};

/// Result of scattering, for the record.
struct SubsurfaceReport {
  std::vector<double> reflectance;  ///< by channel: light that leaves a half space over light that arrives
  std::vector<double> energy;       ///< by channel: the same of this object, lit from everywhere
  double hierarchy_error = 0;       ///< as Scattering has it
  std::size_t error_points = 0;
  double largest_gain = 0;
  double capped_area = 0;
  double area_mm2 = 0;
  double area_correction = 1;  ///< factor that makes the receivers' areas sum to the high mesh's
  double spacing_mm = 0;       ///< root of the receivers' mean area
  double seconds = 0;
};

}  // namespace kiln
