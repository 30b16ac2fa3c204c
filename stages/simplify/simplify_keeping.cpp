// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/simplify_keeping.h"

#include <cmath>
#include <fmt/format.h>
#include <utility>
#include <vector>

#include "base/stopwatch.h"
#include "collapse/level_chain.h"
#include "mesh/mesh_vertices.h"

namespace kiln {

namespace {

constexpr int nominal_texels = 1024;  // of a side of the unit square, for what the collapse measures in texels

/// Largest deviation that a number of triangles is worth, in edges of the result's mean triangle: beyond, the outlines
/// of charts leave so few vertices that the shape is lost.
constexpr double worst_edges = 0.3;

LevelGoal goal_of(const TriangleMesh& mesh, const SimplifySettings& settings, double diagonal) {
  if (settings.max_error > 0) return {0, settings.max_error * diagonal};
  const double edge = std::sqrt(surface_area(mesh) / settings.faces * 4 / std::sqrt(3.0));
  return {settings.faces, worst_edges * edge};
}

/// Says why there are more triangles than were asked for.
std::string shortfall_of(std::size_t triangles, const SimplifySettings& settings) {
  return fmt::format(
      "stopped at {} triangles of {}: no further collapse keeps the charts of its uvs within {:g} of their outlines, "
      "off "
      "each other, and the surface from folding over; give more --faces, a larger --uv-overhang, or leave out uv in "
      "--keep",
      triangles, settings.faces, settings.uv_overhang);
}

}  // namespace

KeepingResult simplify_with_uvs(const ImportedMesh& imported, const KeptSurface& surface,
                                const SimplifySettings& settings, const WrittenWithMaterials& written,
                                const ProgressFunction& progress) {
  const bool by_error = settings.max_error > 0;
  const Stopwatch stopwatch;
  KeepingResult kept{{}, surface.materials.names};
  SimplifyResult& result = kept.simplified;
  result.input_triangles = static_cast<int>(imported.mesh.triangles.size());
  result.dropped = surface.dropped;
  const double diagonal = bounding_box(surface.mesh).diagonal();

  LevelLimits limits;
  limits.size = nominal_texels;
  limits.overhang = limits.farthest_overhang = settings.uv_overhang * nominal_texels;
  limits.layers = surface.layers;
  limits.fits = settings.quality != SimplifyQuality::draft;
  const std::vector<Level> levels =
      make_level_chain(surface.mesh, {goal_of(surface.mesh, settings, diagonal)}, limits, part_of(progress, 0, 0.9));
  const Level& level = levels.front();
  result.collapse_seconds = stopwatch.seconds();
  if (!by_error && !level.reached_goal) result.shortfall = shortfall_of(level.mesh.triangles.size(), settings);
  result.uv_deviation = UvDeviation{level.deviation / diagonal, level.rms_deviation / diagonal};

  VertexMaterials materials{{}, surface.materials.names};
  if (!surface.materials.of_vertex.empty())
    for (const std::uint32_t source : level.sources) materials.of_vertex.push_back(surface.materials.of_vertex[source]);
  const Stopwatch write_stopwatch;
  result.mesh = written(level.mesh, materials);
  const double write_seconds = write_stopwatch.seconds();

  // Measure the file against the input, less what was dropped of it.
  progress(0.9);
  measure_result(result, surface.dropped.components > 0 ? surface.mesh : imported.mesh, imported.mesh.frame, true);
  progress(1);
  result.seconds = stopwatch.seconds() - write_seconds;
  return kept;
}

KeepingResult simplify_with_materials(const ImportedMesh& imported, const SimplifySettings& settings,
                                      const WrittenForm& shape, const WrittenWithMaterials& written,
                                      const ProgressFunction& progress) {
  const std::vector<VertexPair> borders = borders_of_materials(imported);
  KeepingResult kept{simplify(imported.mesh, settings, shape, progress, borders), {}};
  SimplifyResult& result = kept.simplified;
  const Stopwatch stopwatch;
  VertexMaterials materials = take_materials(result.mesh, imported);
  const Stopwatch write_stopwatch;
  result.mesh = written(result.mesh, materials);
  const double write_seconds = write_stopwatch.seconds();

  // Measure the last file, too, against what simplify() measured the one before.
  TriangleMesh whole{imported.mesh.positions, imported.mesh.triangles, {}, {}};
  if (result.dropped.components > 0) drop_small_components(whole, settings);
  measure_result(result, result.dropped.components > 0 ? whole : imported.mesh, imported.mesh.frame, true);
  result.seconds += stopwatch.seconds() - write_seconds;
  kept.materials = std::move(materials.names);
  return kept;
}

}  // namespace kiln
