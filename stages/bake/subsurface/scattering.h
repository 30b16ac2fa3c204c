// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "bake/subsurface/surface_samples.h"
#include "base/progress.h"
#include "scatter/profile.h"
#include "sh/transfer.h"

namespace kiln {

struct ScatteringSettings {
  /// Solid angle, steradians, up to which a group of samples is taken as one (epsilon of [Jensen 2002]); 0: every
  /// sample on its own.
  double solid_angle = 0.05;
  /// Number of points at which every sample is also taken on its own, to measure the error.
  std::size_t error_points = 64;
};

struct Scattering {
  std::vector<TransferVectors> transfer;  ///< one per profile
  /// Energy by profile: what leaves the surface over what arrives, in light that is the same from everywhere.
  std::vector<double> energy;
  double hierarchy_error = 0;  ///< relative L2 at error_points, to sums over every sample
  std::size_t error_points = 0;
  /// Largest ratio of what a point would send out to what it gets, and the share of area (the worst profile's) that was
  /// scaled down to a ratio of 1.
  double largest_gain = 0;
  double capped_area = 0;
};

/// Scatters light that enters at every point of a surface and leaves around it: t'_c(p) = integral over the surface of
/// R_c(|p - q|) t_c(q) dq, so that exit radiance is the sum of L_i t'_i without any further albedo. Irradiance is pi
/// times L . t, exit radiance 1/pi times exitance: both pi cancel. `incoming` has one entry for all profiles or one for
/// each, `samples` (positions in mm, areas in mm^2) are its receivers.
///
/// Sums over samples by the octree of [Jensen 2002], except close to a point: within some four samples' width, on the
/// same side of the object, samples are discs over which R is averaged, and their sum is scaled to the energy that a
/// plane would have there. So R may be narrower than a sample, down to none, which leaves t times total reflectance;
/// wherever samples of two charts stand close together their light counts once; and nothing depends on how samples
/// stand.
///
/// A profile measured on a half space may send more light than arrived through a thin part or a crease that is lit from
/// both sides. Points that would send out more than all are scaled down to all. Any number of threads gives the same
/// bits. Memory: `incoming` twice, the result, and an octree of about a sixth of the samples.
Scattering scatter_transfer(const SurfaceSamples& samples, const std::vector<TransferVectors>& incoming,
                            std::span<const ScatterProfile> profiles, const ScatteringSettings& settings = {},
                            const ProgressFunction& progress = no_progress);

}  // namespace kiln
