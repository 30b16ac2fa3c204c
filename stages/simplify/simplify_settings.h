// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "base/options.h"
#include "import/import_settings.h"

namespace kiln {

/// Price of the result: how long Kiln's own engine may take.
enum class SimplifyQuality {
  draft,     ///< collapses by quadrics, in rounds
  standard,  ///< collapses by quadrics down to a few times the result, then by costs of volume [Lindstrom 1998]
  best       ///< collapses by costs of volume, then vertices and edges are fitted to the input
};

/// Weights of collapses, besides the change of shape.
enum class SimplifyAwareness {
  none,
  transfer  ///< by how much transfer varies there (transfer_weights.h)
};

/// Engine that collapses edges.
enum class SimplifyEngine {
  kiln,  ///< the stage's own collapse, by `quality`
  cgal   ///< CGAL's edge collapse on an OpenMesh mesh, by `cost`
};

/// Cost that CGAL's engine goes by, cheapest first.
enum class CollapseCost {
  lindstrom_turk,         ///< changes of volume and of border areas [Lindstrom 1998]
  plane,                  ///< quadrics of planes [Garland 1997]
  triangle,               ///< quadrics of triangles, weighted by their squared areas [Garland 1997]
  probabilistic_plane,    ///< quadrics of planes that are known up to noise [Trettner 2020]
  probabilistic_triangle  ///< quadrics of triangles that are known up to noise [Trettner 2020]
};

/// Settings of the stage.
struct SimplifySettings {
  int faces = 1000;      ///< triangles to stop at, where max_error is 0
  double max_error = 0;  ///< Hausdorff distance to stop at, as a fraction of the bounding box's diagonal; 0: by faces
  SimplifyQuality quality = SimplifyQuality::standard;
  SimplifyAwareness aware = SimplifyAwareness::none;
  SimplifyEngine engine = SimplifyEngine::kiln;
  CollapseCost cost = CollapseCost::lindstrom_turk;  ///< cost that CGAL's engine goes by
  double max_normal_change = 90;  ///< degrees that a collapse of CGAL's engine may turn a triangle by, above 0
  /// Distance that CGAL's engine may go from the input: no point of the result is farther from it, as a fraction of its
  /// bounding box's diagonal; 0: no limit.
  double envelope = 0;
  double crease = 0;    ///< degrees; edges of a larger dihedral angle (0 in a plane) are feature edges; 0: none
  bool strict = false;  ///< whether an input that needs repair is refused
  ImportSettings import = {};
  /// Size of components that are left out: the diagonal of the box, up to this fraction of the mesh's; 0 keeps all.
  /// "auto": specks of no size beside the result's triangles, where they would take much of `faces`.
  std::string drop_components = "auto";
  std::string keep = "none";  ///< what follows the triangles that are left: none, uv, materials or both, "uv,materials"
  /// Distance that charts of kept uvs may hang over their outlines, as a fraction of the unit square: what lies there
  /// in a texture is its gutter.
  double uv_overhang = 0.002;
  bool colors = false;   ///< whether the input's colours are kept at the vertices
  std::string low = {};  ///< file of a low mesh that is taken as it is, instead of simplification; empty: none
  /// Axis, unit and factor of that file, as `import` has them for the high mesh; "same": those of the high mesh.
  std::string low_up = "same", low_unit = "same", low_scale = "same";

  /// Returns the fraction that drop_components says, or nothing for "auto". Throws WrongUsage for what is neither.
  std::optional<double> drop_size() const;

  /// Tell what `keep` says. Throw WrongUsage for what is none of its words.
  bool keeps_uvs() const;
  bool keeps_materials() const;

  /// Returns how the file `low` is read: as the high mesh, but for what the settings say, and no hole of it is filled.
  /// Throws WrongUsage for a low_up, low_unit or low_scale that is none.
  ImportSettings low_import() const;
};

/// Lists the options that steer simplification alone, which a low mesh that is taken as it is excludes.
std::span<const char* const> steering_options();

OptionSet simplify_options(SimplifySettings& settings);

/// Throws WrongUsage where options are given that exclude each other (faces and max-error, steering_options and low),
/// that the engine has not (quality is of kiln's, cost, max-normal-change and envelope of CGAL's), or that are of a low
/// mesh which is not given. `is_given` tells by an option's name.
void check_options(const SimplifySettings& settings, const std::function<bool(const std::string&)>& is_given);

}  // namespace kiln
