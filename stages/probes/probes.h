#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "asset/probe_set.h"
#include "base/options.h"
#include "base/progress.h"
#include "mesh/triangle_mesh.h"
#include "probes/probes_settings.h"

namespace kiln {

/// Light that the meshes' surface sends on, as radiance per coefficient of the light far away: exit radiance at point p
/// of channel c = sum over j of L_j values[(p * channels + c) * coefficients + j]. Linear over triangles.
struct SentTransfer {
  std::span<const std::array<std::uint32_t, 3>> points;  ///< of each triangle's corners
  std::span<const float> values;
  int channels = 1;
};

struct ProbesResult {
  ProbeSet probes;
  double seconds = 0;
  double open_share = 0;  ///< of the sky that valid points see, their mean

  std::size_t invalid() const;
  Json to_json() const;
};

/// Appends positions and triangles.
void append_mesh(TriangleMesh& mesh, const TriangleMesh& other);

/// Where the probes stand: a grid in `settings.box`, or around `mesh`; or `points`, if there are any.
ProbeSet place_probes(const TriangleMesh& mesh, const std::vector<Eigen::Vector3f>& points,
                      const ProbesSettings& settings);

/// The matrices of the probes: M_ij = integral of B_i(s) B_j(s) V(s) ds, V whether the point sees the sky along s, plus
/// integral of B_i(s) r_j(q(s)) ds where it sees the front of `mesh` at q, r what `sent` sends from there (nothing
/// without it; backs send nothing). Points that `mesh` goes around are not valid. Integrals are sums over
/// settings.directions directions drawn with `seed`; that over the sky is corrected by the error of the same sum over
/// the whole sphere, times the open share, so that a point which sees nothing of `mesh` has the identity exactly. The
/// same bits for any number of threads.
ProbesResult probe_matrices(const TriangleMesh& mesh, const SentTransfer* sent, ProbeSet probes,
                            const ProbesSettings& settings, int seed, const ProgressFunction& progress = no_progress);

}  // namespace kiln
