// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

namespace kiln {

/// What one small build of an asset measured.
struct PilotBuild {
  double triangles = 0;      ///< of the low mesh
  double vertices = 0;       ///< of the low mesh
  double size = 0;           ///< texels along a side of the atlas
  double texels = 0;         ///< covered ones
  double cache_points = 0;   ///< points of the surface at which light bounces
  double directions = 0;     ///< of the bake
  int bands = 0;             ///< of the bake
  std::vector<double> seen;  ///< squares of the transfer seen, by band (report/error_causes.h)
  std::map<std::string, std::vector<double>> squares;  ///< of each cause, by band
  std::vector<double> at_vertices;  ///< what lookups between vertices would cost in place of texels, by band; empty:
                                    ///< the asset needs textures
  std::vector<double> unshadowed;   ///< what leaving out shadows would cost, by band; empty: not known
  double total = 0;                 ///< E
  double uncertainty = 0;           ///< of E, of 95 % confidence
  double root_sum = 0;              ///< root of the sum of the causes' squares
  std::map<std::string, double> cpu_seconds;  ///< by stage
  double mesh_bytes = 0;                      ///< of the mesh
  double map_bytes = 0;                       ///< of the maps of normals and albedo
  double plane_bytes = 0;                     ///< of the planes, or of what kiln-compress made of them
};

/// Two builds of an asset, the second with more triangles, texels and directions, and what is known of its mesh.
struct Pilot {
  PilotBuild coarse, fine;
  PilotBuild without_bounces;      ///< like `coarse`, without bounces, against a reference that has them
  bool has_bounces = false;        ///< whether light bounces, and `without_bounces` is there
  bool must_bounce = false;        ///< whether it has to, at wavelengths; `without_bounces` is not there then
  PilotBuild compressed;           ///< like `fine`, with the bands chosen, compressed
  bool is_compressed = false;      ///< whether that is there
  double input_triangles = 0;      ///< of the high mesh
  bool has_own_low = false;        ///< whether the low mesh is the asset's own, whose triangles are no choice
  bool may_be_vertices = false;    ///< whether both builds have `at_vertices`, and the pipeline allows such a bake
  bool may_be_unshadowed = false;  ///< whether the pilot knows `unshadowed`, and the pipeline allows such a bake
  bool must_be_vertices = false;   ///< whether the pipeline asks for it
};

/// Settings that a plan decides for an asset.
struct Choice {
  int triangles = 0;
  int size = 0;  ///< texels along a side of the atlas; 0 where vertices are baked
  int bands = 0;
  int directions = 0;  ///< 0: the bake has no shadows
  int bits = 8;
  bool bounces = false;     ///< whether light bounces, as often as the pipeline says
  double compression = 0;   ///< E that kiln-compress may add, by the measured prior; 0: not compressed
  bool per_vertex = false;  ///< whether transfer is baked into the vertices of the low mesh, without an atlas
};

/// What an asset of a choice costs and how wrong it is.
struct Prediction {
  double error = 0;
  double uncertainty = 0;  ///< of the error, as the pilot's, of 95 % confidence
  std::map<std::string, double> causes;
  double cpu_seconds = 0;  ///< of all stages up to the last that makes what ships
  double bytes = 0;        ///< of what ships
};

/// Predicts errors and costs of an asset's settings from its pilot. Each cause of the error follows one setting by a
/// power law through both builds: geometry, receivers on the low mesh and lookups between its vertices the triangles,
/// texels, seams and albedo the covered texels, directions their number. The square of rounding falls by four for each
/// bit. Costs are linear in the work of a stage, those of the bake a power of it.
class AssetModel {
 public:
  explicit AssetModel(Pilot pilot);

  const Pilot& pilot() const { return pilot_; }

  /// Largest number of bands that the pilot knows.
  int most_bands() const { return pilot_.fine.bands; }

  /// Returns the covered texels of an atlas of so many a side.
  double texels(double size) const;

  Prediction predict(const Choice& choice) const;

 private:
  /// Returns the points that a choice bakes: texels, or vertices.
  double receivers(const Choice& choice) const;
  double vertices(const Choice& choice) const;
  double bake_seconds(const Choice& choice) const;
  double cpu_seconds(const Choice& choice) const;
  double bytes(const Choice& choice) const;

  Pilot pilot_;
};

/// Returns the error that a cause has in a build's first `bands` bands; 0 where the build has no such cause.
double error_of(const PilotBuild& build, const std::string& cause, int bands);

/// Returns the value at `x` of the power law through (x1, y1) and (x2, y2), x1 < x2, whose exponent is `most` at most
/// and, where x is beyond x2, `least` at least; of two points that are one, or values that are not above 0, the second
/// value.
double power_law(double x1, double y1, double x2, double y2, double x, double least, double most);

}  // namespace kiln
