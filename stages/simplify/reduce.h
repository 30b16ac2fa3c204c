// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "base/progress.h"
#include "mesh/mesh_distance.h"
#include "mesh/triangle_mesh.h"
#include "simplify/feature_edges.h"
#include "simplify/simplify_settings.h"

namespace kiln {

/// Reduced mesh, and which of the hard feature edges that were given are left in it: each once, the smaller vertex
/// first, sorted.
struct Reduced {
  TriangleMesh mesh;
  std::vector<VertexPair> feature_edges;
  bool met_envelope = false;  ///< true where collapses were refused as they would have left settings.envelope
};

/// Measure of the input's distances to a candidate. May return less where the Hausdorff distance is more than
/// max_error.
using CandidateDistance = std::function<MeshDistance(const TriangleMesh&)>;

/// Reduces an oriented manifold to settings.faces triangles (settings.max_error is not used), of the same topology; to
/// more where no collapse is left that keeps topology and shape. `vertex_weights`: as in
/// CollapseSettings; `lines` are its feature edges.
Reduced reduce_to_faces(const TriangleMesh& manifold, const SimplifySettings& settings,
                        const CandidateDistance& distance, std::span<const double> vertex_weights = {},
                        const FeatureLines& lines = {}, const ProgressFunction& progress = no_progress);

/// Reduces it to the fewest triangles, to 1 %, whose Hausdorff distance stays within settings.max_error
/// (settings.faces is not used); the manifold itself where none does.
Reduced reduce_to_error(const TriangleMesh& manifold, const SimplifySettings& settings,
                        const CandidateDistance& distance, std::span<const double> vertex_weights = {},
                        const FeatureLines& lines = {}, const ProgressFunction& progress = no_progress);

}  // namespace kiln
