// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "base/json_fwd.h"
#include "base/progress.h"
#include "mesh/mesh_distance.h"
#include "mesh/mesh_repair.h"
#include "mesh/triangle_mesh.h"
#include "simplify/feature_edges.h"
#include "simplify/simplify_settings.h"
#include "simplify/small_components.h"

namespace kiln {

/// How far textures slide where uvs are kept: distances between where a uv lies on the input and on the result, at the
/// input's vertices and the middles of its edges, as fractions of its bounding box's diagonal.
struct UvDeviation {
  double largest = 0;
  double rms = 0;  ///< over the surface
};

/// Simplified mesh, and what was measured of it.
struct SimplifyResult {
  TriangleMesh mesh;              ///< the mesh as written and read again, with normals
  MeshDistance distance;          ///< distances of the input to `mesh`
  double hausdorff_distance = 0;  ///< distance.hausdorff in object units
  int input_triangles = 0;
  DroppedComponents dropped;     ///< components of the input that were left out; distances are to what is left of it
  std::string shortfall;         ///< reason why there are more than settings.faces triangles; empty where there are not
  bool manifold = false;         ///< whether it is an oriented manifold, possibly with border
  bool closed = false;           ///< whether it is a manifold without border
  int degenerate_triangles = 0;  ///< count_degenerate
  int flipped_triangles = 0;     ///< count_flipped within flipped_reach of the input
  std::optional<UvDeviation> uv_deviation;  ///< where uvs are kept
  double seconds = 0;                       ///< time of it all, without `written`
  double collapse_seconds = 0;  ///< time of the collapses and fits, without repairs and the result's distances

  Json to_json() const;
};

/// Counts triangles without area.
int count_degenerate(const TriangleMesh& mesh);

/// Counts triangles of `mesh` that face against what they stand for: the part of `high` that is nearest to their middle
/// faces against them, and no part within `reach` more than that distance faces as they do. Where parts of the input
/// lie closer together than the error (thin walls, parts that go through each other), the nearest is often another
/// part's.
int count_flipped(const TriangleMesh& mesh, const TriangleMesh& high, double reach);

/// Returns the reach with which count_flipped is asked for a result: half an edge of its mean triangle, or twice its
/// Hausdorff distance.
double flipped_reach(const TriangleMesh& mesh, double hausdorff_distance);

/// Writer of candidates: puts a mesh into its file, reads that again and returns what it holds. Called for every
/// candidate that is measured; the last call is for the result.
using WrittenForm = std::function<TriangleMesh(const TriangleMesh&)>;

/// Returns the mesh as it is with vertex normals: the WrittenForm of no file.
TriangleMesh with_normals(const TriangleMesh& mesh);

/// Simplifies `high` by edge collapse to at most settings.faces triangles, or to the fewest that keep its Hausdorff
/// distance from `high` within settings.max_error. Where that many cannot be had without damage there are more, and
/// `shortfall` says why; a mesh that has no more to begin with is returned as it is. A manifold stays one, of the same
/// topology; what is none is split into one. Throws WrongUsage for a max_error or envelope that no file of 16 bits can
/// keep, and for an envelope of another engine than CGAL's. Edges of `kept_lines` collapse along themselves alone, as
/// hard edges do, and are shaded smoothly.
SimplifyResult simplify(const TriangleMesh& high, const SimplifySettings& settings,
                        const WrittenForm& written = with_normals, const ProgressFunction& progress = no_progress,
                        const std::vector<VertexPair>& kept_lines = {});

/// Measures result.mesh, as written, against what it stands for, `measured`, both in `frame`. `is_split` says whether
/// vertices of one position may be several.
void measure_result(SimplifyResult& result, const TriangleMesh& measured, const MeshFrame& frame, bool is_split);

/// Takes `low` as the low mesh of `high`, both in one frame, and measures it as simplify() does. Nothing is removed.
SimplifyResult take_low(const TriangleMesh& high, const TriangleMesh& low, const WrittenForm& written = with_normals,
                        const ProgressFunction& progress = no_progress);

}  // namespace kiln
