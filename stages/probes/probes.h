// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "asset/probe_set.h"
#include "base/json_fwd.h"
#include "base/progress.h"
#include "mesh/triangle_mesh.h"
#include "probes/probes_settings.h"
#include "probes/surface_light.h"

namespace kiln {

struct ProbesResult {
  ProbeSet probes;
  double open_share = 0;  ///< mean share of the sky that valid points see
  int bounces = 0;
  double last_bounce_share = 0;    ///< share of the last bounce in the light of the surface, relative L2
  std::size_t surface_points = 0;  ///< points at which light bounces

  std::size_t invalid() const;
  Json to_json() const;
};

/// Places probes: a grid in `settings.box`, or around `mesh`; or `points`, if there are any.
ProbeSet place_probes(const TriangleMesh& mesh, const std::vector<Eigen::Vector3f>& points,
                      const ProbesSettings& settings);

/// Computes the matrices of the probes: M_ij = integral of B_i(s) B_j(s) V(s) ds, where V tells whether the point sees
/// the sky along s, plus the integral of B_i(s) r_j(q(s)) ds over directions along which it sees the front of `mesh` at
/// q, where r is what `light` sends from there (backs send nothing). Points inside `mesh` (by winding number) are not
/// valid. Integrals are sums over settings.directions directions drawn with `seed`; the one over the sky is corrected
/// by the error of the same sum over the whole sphere, times the open share, so that a point that sees nothing of
/// `mesh` has the identity exactly. The same bits for any number of threads.
ProbesResult probe_matrices(const TriangleMesh& mesh, const SurfaceLight& light, ProbeSet probes,
                            const ProbesSettings& settings, int seed, const ProgressFunction& progress = no_progress);

}  // namespace kiln
