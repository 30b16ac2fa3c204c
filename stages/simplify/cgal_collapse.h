// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/progress.h"
#include "mesh/triangle_mesh.h"
#include "simplify/collapse.h"
#include "simplify/simplify_settings.h"

namespace kiln {

/// Settings of CGAL's edge collapse besides those that both engines have.
struct CgalSettings {
  CollapseCost cost = CollapseCost::lindstrom_turk;
  double max_normal_change = 90;  ///< degrees that one collapse may turn a triangle by, above 0 and at most 90
  /// Largest distance of the result from the input, a fraction of its box's diagonal; 0: no limit.
  double envelope = 0;
};

/// Collapses edges of an oriented manifold by CGAL's Surface_mesh_simplification on an OpenMesh mesh, cheapest first,
/// until at most settings.faces triangles are left or no collapse is left that is allowed. settings.compared_faces is
/// not used; the crease angle, feature edges and weights are. Refused are collapses that break the topology, turn a
/// triangle too far (CGAL's Bounded_normal_change_filter, and max_normal_change), make one too thin for the file, join
/// or shorten feature lines (borders among them), or leave the envelope (CGAL's Polyhedral_envelope). What is within
/// the envelope stays there when positions are rounded to floats, and to the 16 bits of the file. Costs are those of
/// [Lindstrom 1998], [Garland 1997] and [Trettner 2020]; the envelope's prisms are tested by [Wang 2020].
CollapseSequence collapse_by_cgal(TriangleMesh mesh, const CollapseSettings& settings, const CgalSettings& cgal,
                                  const ProgressFunction& progress = no_progress);

/// Returns how far rounding to floats, and to the 16 bits of the file, may move a point of this mesh, as a fraction of
/// its box's diagonal.
double rounding_of_file(const TriangleMesh& mesh);

}  // namespace kiln
