#include "simplify/simplify.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/command_line.h"
#include "base/errors.h"
#include "mesh/nearest_surface.h"
#include "simplify/collapse.h"

namespace kiln {

namespace {

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

/// Writes candidates, and keeps the time of it apart.
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

/// Whether `low`'s distance is within `max_error`; few samples suffice to see most that are not.
bool is_within(const TriangleMesh& high, const TriangleMesh& low, double max_error) {
  for (const int samples : {2'000, MeshDistanceSettings().samples})
    if (mesh_distance(high, low, {.samples = samples}).hausdorff > max_error) return false;
  return true;
}

/// The largest number of collapses that keeps within `max_error`, to 1 % in the number of triangles, by bisection.
std::size_t count_within(const CollapseSequence& sequence, const TriangleMesh& high, double max_error, Writer& write,
                         const ProgressFunction& progress) {
  const auto faces_after = [&](std::size_t count) {
    return count == 0 ? static_cast<double>(sequence.start.triangles.size()) : sequence.collapses[count - 1].faces;
  };
  const auto within = [&](std::size_t count) { return is_within(high, write(sequence.after(count)), max_error); };
  std::size_t good = 0;
  std::size_t bad = sequence.collapses.size() + 1;
  if (within(bad - 1)) return bad - 1;
  --bad;
  const double start_gap = std::log(faces_after(good) / faces_after(bad));
  for (double gap = start_gap; bad - good > 1 && gap > 0.01; gap = std::log(faces_after(good) / faces_after(bad))) {
    progress(1 - std::log(gap / 0.01) / std::log(start_gap / 0.01));
    // Errors grow by powers of the number of triangles, so its logarithm is halved.
    const double wanted = std::sqrt(faces_after(good) * faces_after(bad));
    std::size_t middle = good + 1;
    for (std::size_t last = bad - 1; middle < last;) {
      const std::size_t half = (middle + last) / 2;
      if (faces_after(half) <= wanted)
        last = half;
      else
        middle = half + 1;
    }
    (within(middle) ? good : bad) = middle;
  }
  return good;
}

}  // namespace

int count_degenerate(const TriangleMesh& mesh) {
  return count_facets(mesh, [](const Facet& facet) { return !(facet.area_normal.squaredNorm() > 0); });
}

int count_flipped(const TriangleMesh& mesh, const TriangleMesh& high) {
  const NearestSurface surface(high);
  return count_facets(mesh, [&](const Facet& facet) {
    return facet.area_normal.dot(surface.normal(surface.nearest(facet.middle))) < 0;
  });
}

TriangleMesh with_normals(const TriangleMesh& mesh) {
  TriangleMesh result = mesh;
  compute_vertex_normals(result);
  return result;
}

SimplifyResult simplify(const TriangleMesh& high, const SimplifySettings& settings, const WrittenForm& written,
                        const ProgressFunction& progress) {
  constexpr double smallest_max_error = 1e-4;  // several steps of 16 bits
  const bool by_error = settings.max_error > 0;
  if (by_error && settings.max_error < smallest_max_error)
    throw WrongUsage("max-error: found " + std::to_string(settings.max_error) + ", expected 0 or 0.0001 to 1");
  const Stopwatch stopwatch;
  Writer write(written);
  SimplifyResult result;
  result.input_triangles = static_cast<int>(high.triangles.size());

  // Collapse: down to the number of triangles that is asked for, or as far as it goes.
  TriangleMesh manifold = to_manifold(high, result.repairs);
  const Stopwatch collapse_stopwatch;
  const double collapse_share = by_error ? 0.4 : 0.8;
  const CollapseSequence sequence = collapse_edges(std::move(manifold), settings.cost, by_error ? 4 : settings.faces,
                                                   [&](double fraction) { progress(collapse_share * fraction); });
  result.collapse_seconds = collapse_stopwatch.seconds();

  // Choose how many of the collapses to keep.
  std::size_t count = sequence.collapses.size();
  if (by_error)
    count = count_within(sequence, high, settings.max_error, write,
                         [&](double fraction) { progress(collapse_share + (0.9 - collapse_share) * fraction); });
  result.mesh = write(sequence.after(count));

  // Measure what was written.
  progress(0.9);
  result.distance = mesh_distance(high, result.mesh);
  result.hausdorff_distance = result.distance.hausdorff * bounding_box(high).diagonal();
  result.manifold = is_manifold(result.mesh);
  result.closed = result.manifold && is_closed(result.mesh);
  result.degenerate_triangles = count_degenerate(result.mesh);
  result.flipped_triangles = count_flipped(result.mesh, high);
  progress(1);
  result.seconds = stopwatch.seconds() - write.seconds();
  return result;
}

Json SimplifyResult::to_json() const {
  return {{"triangles", mesh.triangles.size()},
          {"vertices", mesh.positions.size()},
          {"input_triangles", input_triangles},
          {"hausdorff", distance.hausdorff},
          {"rms", distance.rms},
          {"hausdorff_distance", hausdorff_distance},
          {"manifold", manifold},
          {"closed", closed},
          {"degenerate_triangles", degenerate_triangles},
          {"flipped_triangles", flipped_triangles},
          {"collapse_seconds", collapse_seconds}};
}

}  // namespace kiln
