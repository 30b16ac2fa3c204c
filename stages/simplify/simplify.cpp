// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/simplify.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "base/json.h"
#include "base/stopwatch.h"
#include "mesh/hard_edges.h"
#include "mesh/nearest_surface.h"
#include "mesh/same_position.h"
#include "simplify/reduce.h"
#include "simplify/transfer_weights.h"

namespace kiln {

namespace {

/// Triangle as a place and a direction.
struct Facet {
  Eigen::Vector3d middle;
  Eigen::Vector3d area_normal;  ///< as long as twice the area
};

Facet facet(const TriangleMesh& mesh, const Triangle& triangle) {
  const Eigen::Vector3d a = mesh.positions[triangle[0]].cast<double>();
  const Eigen::Vector3d b = mesh.positions[triangle[1]].cast<double>();
  const Eigen::Vector3d c = mesh.positions[triangle[2]].cast<double>();
  return {(a + b + c) / 3, (b - a).cross(c - a)};
}

template <class Predicate>
int count_facets(const TriangleMesh& mesh, const Predicate& predicate) {
  return static_cast<int>(std::count_if(mesh.triangles.begin(), mesh.triangles.end(),
                                        [&](const Triangle& triangle) { return predicate(facet(mesh, triangle)); }));
}

/// Writer of candidates that keeps its time apart.
class Writer {
 public:
  explicit Writer(const WrittenForm& written) : written_(written) {}

  TriangleMesh operator()(const TriangleMesh& mesh) {
    const Stopwatch stopwatch;
    TriangleMesh form = written_(mesh);
    seconds_ += stopwatch.seconds();
    return form;
  }
  double seconds() const { return seconds_; }

 private:
  const WrittenForm& written_;
  double seconds_ = 0;
};

/// Measures distances; few samples suffice to see most candidates that are too far.
MeshDistance distance_within(const TriangleMesh& high, const TriangleMesh& low, double max_error) {
  const MeshDistance least = mesh_distance(high, low, {.samples = 2'000});
  return least.hausdorff > max_error ? least : mesh_distance(high, low);
}

/// Finds the hard edges of the input that its shape has, too: where it is all but flat, the normal map can do without
/// the edge.
std::vector<VertexPair> feature_edges_of(const TriangleMesh& high) {
  constexpr double least_dihedral_degrees = 15;
  const HardEdges hard = hard_edges_of_normals(high);
  if (hard.empty()) return {};
  const HardEdges bent = hard_edges_by_angle(high, least_dihedral_degrees);
  std::vector<VertexPair> features;
  std::set_intersection(hard.begin(), hard.end(), bent.begin(), bent.end(), std::back_inserter(features));
  return features;
}

/// Throws WrongUsage for distances that no file can keep, and for an envelope without the engine that has one.
void check_distances(const SimplifySettings& settings) {
  constexpr double smallest = 1e-4;  // several steps of 16 bits
  for (const auto& [name, distance] : {std::pair("max-error", settings.max_error), {"envelope", settings.envelope}})
    if (distance != 0 && !(distance >= smallest))
      throw WrongUsage(name + fmt::format(": found {:g}, expected 0 or 0.0001 to 1", distance));
  if (settings.envelope > 0 && settings.engine != SimplifyEngine::cgal)
    throw WrongUsage("envelope: only --engine cgal keeps one");
}

/// Says why there are more triangles than were asked for.
std::string shortfall_of(const Reduced& low, const SimplifySettings& settings, std::size_t triangles,
                         const std::string& other_reason) {
  const std::string reason = low.met_envelope
                                 ? fmt::format(
                                       "no further collapse keeps within the envelope of {:g} of the diagonal; give a "
                                       "larger --envelope or more --faces",
                                       settings.envelope)
                                 : other_reason;
  return fmt::format("stopped at {} triangles of {}: {}", triangles, settings.faces, reason);
}

/// Returns the simplified mesh with normals that are smooth but for its feature edges, in the input's frame.
TriangleMesh shaded(const Reduced& reduced, const MeshFrame& frame) {
  TriangleMesh mesh = reduced.mesh;
  mesh.frame = frame;
  compute_normals_between(mesh, reduced.feature_edges);
  return mesh;
}

}  // namespace

int count_degenerate(const TriangleMesh& mesh) {
  return count_facets(mesh, [](const Facet& facet) { return !(facet.area_normal.squaredNorm() > 0); });
}

int count_flipped(const TriangleMesh& mesh, const TriangleMesh& high, double reach) {
  const NearestSurface surface(high);
  return count_facets(mesh, [&](const Facet& facet) {
    const NearestSurface::Hit hit = surface.nearest(facet.middle);
    if (facet.area_normal.dot(surface.normal(hit)) >= 0) return false;
    const double within = std::sqrt(hit.squared_distance) + reach;
    return !surface.nearest_facing(facet.middle, {facet.area_normal, 0, within}, hit.hint);
  });
}

double flipped_reach(const TriangleMesh& mesh, double hausdorff_distance) {
  const double mean_area = surface_area(mesh) / static_cast<double>(std::max<std::size_t>(1, mesh.triangles.size()));
  return std::max(2 * hausdorff_distance, 0.5 * std::sqrt(mean_area * 4 / std::sqrt(3.0)));
}

TriangleMesh with_normals(const TriangleMesh& mesh) {
  TriangleMesh result = split_at_hard_edges(mesh);
  compute_vertex_normals(result);
  return result;
}

void measure_result(SimplifyResult& result, const TriangleMesh& measured, const MeshFrame& frame, bool is_split) {
  result.distance = mesh_distance(measured, result.mesh);
  const double hausdorff_distance = result.distance.hausdorff * bounding_box(measured).diagonal();
  result.hausdorff_distance = hausdorff_distance * frame.unit();
  result.manifold = is_manifold(result.mesh);
  result.closed = result.manifold && is_closed(is_split ? join_at_positions(result.mesh) : result.mesh);
  result.degenerate_triangles = count_degenerate(result.mesh);
  result.flipped_triangles = count_flipped(result.mesh, measured, flipped_reach(result.mesh, hausdorff_distance));
}

SimplifyResult simplify(const TriangleMesh& high, const SimplifySettings& settings, const WrittenForm& written,
                        const ProgressFunction& progress, const std::vector<VertexPair>& kept_lines) {
  check_distances(settings);
  const bool by_error = settings.max_error > 0;
  const Stopwatch stopwatch;
  Writer write(written);
  SimplifyResult result;
  result.input_triangles = static_cast<int>(high.triangles.size());

  TriangleMesh manifold{high.positions, high.triangles, {}, {}};
  FeatureLines lines;
  if (is_manifold(manifold))  // import_mesh gives one
    lines = {feature_edges_of(high), kept_lines};
  else
    repair_mesh(manifold);
  result.dropped = drop_small_components(manifold, settings);
  const TriangleMesh& measured = result.dropped.components > 0 ? manifold : high;
  std::vector<double> weights;
  if (settings.aware == SimplifyAwareness::transfer) weights = transfer_weights(manifold);
  const Stopwatch reduce_stopwatch;
  const CandidateDistance distance = [&](const TriangleMesh& candidate) {
    const TriangleMesh form = write(candidate);
    return by_error ? distance_within(measured, form, settings.max_error) : mesh_distance(measured, form);
  };
  const auto reduce = by_error ? reduce_to_error : reduce_to_faces;
  const Reduced low = reduce(manifold, settings, distance, weights, lines, part_of(progress, 0, 0.9));
  result.collapse_seconds = reduce_stopwatch.seconds();
  result.mesh = write(shaded(low, high.frame));

  progress(0.9);
  measure_result(result, measured, high.frame, !lines.hard.empty());
  if (!by_error && result.mesh.triangles.size() > static_cast<std::size_t>(settings.faces))
    result.shortfall =
        shortfall_of(low, settings, result.mesh.triangles.size(), why_no_fewer(result.mesh, settings.faces, manifold));
  progress(1);
  result.seconds = stopwatch.seconds() - write.seconds();
  return result;
}

SimplifyResult take_low(const TriangleMesh& high, const TriangleMesh& low, const WrittenForm& written,
                        const ProgressFunction& progress) {
  const Stopwatch stopwatch;
  Writer write(written);
  SimplifyResult result;
  result.input_triangles = static_cast<int>(high.triangles.size());
  progress(0);
  result.mesh = write(low);
  measure_result(result, high, high.frame, true);
  progress(1);
  result.seconds = stopwatch.seconds() - write.seconds();
  return result;
}

Json SimplifyResult::to_json() const {
  Json json = {{"triangles", mesh.triangles.size()},
               {"vertices", mesh.positions.size()},
               {"input_triangles", input_triangles},
               {"dropped_components", dropped.components},
               {"dropped_triangles", dropped.triangles},
               {"dropped_area", dropped.area_share},
               {"dropped_size", dropped.largest_size},
               {"hausdorff", distance.hausdorff},
               {"hausdorff_from_result", distance.hausdorff_from_second},
               {"rms", distance.rms},
               {"hausdorff_distance", hausdorff_distance},
               {"manifold", manifold},
               {"closed", closed},
               {"degenerate_triangles", degenerate_triangles},
               {"flipped_triangles", flipped_triangles},
               {"collapse_seconds", collapse_seconds}};
  if (uv_deviation) {
    json["uv_deviation"] = uv_deviation->largest;
    json["uv_deviation_rms"] = uv_deviation->rms;
  }
  return json;
}

}  // namespace kiln
