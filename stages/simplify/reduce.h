#pragma once

#include <functional>
#include <span>

#include "base/progress.h"
#include "mesh/triangle_mesh.h"
#include "simplify/simplify_settings.h"

namespace kiln {

/// An oriented manifold with settings.faces triangles (settings.max_error is not used), of the same topology; more
/// where no collapse is left that keeps topology and shape. `vertex_weights`: as in CollapseSettings.
TriangleMesh reduce_to_faces(const TriangleMesh& manifold, const SimplifySettings& settings,
                             std::span<const double> vertex_weights = {},
                             const ProgressFunction& progress = no_progress);

/// The Hausdorff distance of a candidate from the input, as a fraction of the diagonal. May say less where it is more
/// than max_error.
using CandidateError = std::function<double(const TriangleMesh&)>;

/// The same with the fewest triangles, to 1 %, for which `error` stays within settings.max_error (settings.faces is not
/// used); the manifold itself where none does.
TriangleMesh reduce_to_error(const TriangleMesh& manifold, const SimplifySettings& settings,
                             const CandidateError& error, std::span<const double> vertex_weights = {},
                             const ProgressFunction& progress = no_progress);

}  // namespace kiln
