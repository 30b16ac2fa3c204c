#pragma once

#include <functional>
#include <string>

#include "base/options.h"
#include "base/progress.h"
#include "mesh/mesh_distance.h"
#include "mesh/mesh_repair.h"
#include "mesh/triangle_mesh.h"
#include "simplify/simplify_settings.h"
#include "simplify/small_components.h"

namespace kiln {

struct SimplifyResult {
  TriangleMesh mesh;              ///< as written and read again, with normals
  MeshDistance distance;          ///< of the input to `mesh`
  double hausdorff_distance = 0;  ///< distance.hausdorff in object units
  int input_triangles = 0;
  DroppedComponents dropped;     ///< of the input; distances are to what is left of it
  std::string shortfall;         ///< why there are more than settings.faces triangles; empty where there are not
  bool manifold = false;         ///< an oriented manifold, possibly with border
  bool closed = false;           ///< and without border
  int degenerate_triangles = 0;  ///< count_degenerate
  int flipped_triangles = 0;     ///< count_flipped within flipped_reach of the input
  double seconds = 0;            ///< without `written`
  double collapse_seconds = 0;   ///< of it, without repairs and the result's distances

  Json to_json() const;
};

/// Triangles without area.
int count_degenerate(const TriangleMesh& mesh);

/// Triangles of `mesh` that face against what they stand for: the part of `high` that is nearest to their middle faces
/// against them, and no part within `reach` more than that distance faces as they do. Where parts of the input lie
/// closer together than the error (thin walls, parts that go through each other), the nearest is often another part's.
int count_flipped(const TriangleMesh& mesh, const TriangleMesh& high, double reach);

/// What is asked of count_flipped for a result: half an edge of its mean triangle, or twice its Hausdorff distance.
double flipped_reach(const TriangleMesh& mesh, double hausdorff_distance);

/// What a mesh is once it was written to a file and read again. Called for every candidate; the last call is for the
/// result.
using WrittenForm = std::function<TriangleMesh(const TriangleMesh&)>;

/// Keeps the mesh as it is, but for vertex normals.
TriangleMesh with_normals(const TriangleMesh& mesh);

/// A mesh of at most settings.faces triangles, or with the fewest that keep its Hausdorff distance from `high` within
/// settings.max_error, by edge collapse. Where that many cannot be had without damage there are more, and `shortfall`
/// says why; a mesh that has no more to begin with is returned as it is. A manifold stays one, of the same topology;
/// what is none is split into one. Throws WrongUsage for a max_error that no file of 16 bits can keep.
SimplifyResult simplify(const TriangleMesh& high, const SimplifySettings& settings,
                        const WrittenForm& written = with_normals, const ProgressFunction& progress = no_progress);

}  // namespace kiln
