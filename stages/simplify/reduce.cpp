#include "simplify/reduce.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "simplify/collapse.h"
#include "simplify/collapsing_mesh.h"
#include "simplify/fit.h"

namespace kiln {

namespace {

/// Of the result: standard's first step goes this far, and from the latter on, triangles are compared with the surface.
constexpr int quick_times = 3, compared_times = 3;

int times(int factor, int faces) {
  return static_cast<int>(std::min<long long>(static_cast<long long>(factor) * faces, std::numeric_limits<int>::max()));
}

/// What is left after `count` collapses, fitted to the start. Vertices of borders and creases stay.
TriangleMesh fitted(const CollapseSequence& sequence, std::size_t count, double crease_degrees,
                    const ProgressFunction& progress) {
  std::vector<std::uint32_t> origins;
  const TriangleMesh low = sequence.after(count, &origins);
  if (count == 0) return low;
  std::vector<std::uint8_t> in_line(sequence.start.positions.size(), 0);
  for (const auto& [a, b] : feature_lines(sequence.start, crease_degrees)) in_line[a] = in_line[b] = 1;
  // A vertex of a line is never made another's that is none's.
  std::vector<std::uint8_t> is_fixed;
  for (std::uint32_t origin : origins) is_fixed.push_back(in_line[origin]);
  return fit_to_surface(low, sequence.start, is_fixed, {}, progress);
}

ProgressFunction part(const ProgressFunction& progress, double begin, double end) {
  return [&progress, begin, end](double fraction) { progress(begin + (end - begin) * fraction); };
}

/// Collapses for a result of about `faces`, on to the last that is possible where `goes_on`.
CollapseSequence collapse(const TriangleMesh& manifold, const SimplifySettings& settings, int faces, bool goes_on,
                          std::span<const double> vertex_weights, const ProgressFunction& progress) {
  CollapseSettings collapse;
  collapse.faces = goes_on ? 4 : faces;
  collapse.crease_degrees = settings.crease;
  collapse.vertex_weights = vertex_weights;
  switch (settings.quality) {
    case SimplifyQuality::draft:
      collapse.compared_faces = 0;
      return collapse_edges_in_two_steps(manifold, collapse.faces, collapse, progress);
    case SimplifyQuality::standard:
      collapse.compared_faces = times(compared_times, faces);
      return collapse_edges_in_two_steps(manifold, times(quick_times, faces), collapse, progress);
    case SimplifyQuality::best:
      break;
  }
  return collapse_edges(manifold, collapse, progress);
}

/// The most collapses that keep within max_error, to 1 % in the number of triangles, by bisection.
std::size_t count_within(const CollapseSequence& sequence, double max_error, const CandidateError& error,
                         const ProgressFunction& progress) {
  const auto faces_after = [&](std::size_t count) { return static_cast<double>(sequence.faces_after(count)); };
  const auto within = [&](std::size_t count) { return error(sequence.after(count)) <= max_error; };
  std::size_t good = 0, bad = sequence.collapses.size();
  if (bad == 0 || within(bad)) return bad;
  const double start_gap = std::log(faces_after(good) / faces_after(bad));
  for (double gap = start_gap; bad - good > 1 && gap > 0.01; gap = std::log(faces_after(good) / faces_after(bad))) {
    progress(std::clamp(1 - std::log(gap / 0.01) / std::log(start_gap / 0.01), 0.0, 1.0));
    // Errors grow by powers of the number of triangles, so its logarithm is halved.
    const double wanted = std::sqrt(faces_after(good) * faces_after(bad));
    const std::size_t middle = std::clamp(sequence.count_for(static_cast<int>(wanted)), good + 1, bad - 1);
    (within(middle) ? good : bad) = middle;
  }
  return good;
}

/// The fitted mesh of the fewest triangles within max_error. Fits take long, so each is made where the last ones say
/// that the bound is: the error goes with the area of a triangle.
TriangleMesh fitted_within(const CollapseSequence& sequence, std::size_t unfitted_count,
                           const SimplifySettings& settings, const CandidateError& error,
                           const ProgressFunction& progress) {
  constexpr int most_fits = 8;
  TriangleMesh best = sequence.after(unfitted_count);
  double good = sequence.faces_after(unfitted_count), bad = 4, guess = 0.7 * good;
  for (int i = 0; i < most_fits && good > 1.01 * bad; ++i) {
    const std::size_t count = sequence.count_for(static_cast<int>(std::lround(guess)));
    const double faces = sequence.faces_after(count);
    if (!(faces < good)) break;
    const TriangleMesh candidate = fitted(sequence, count, settings.crease,
                                          part(progress, static_cast<double>(i) / most_fits, (i + 1.0) / most_fits));
    const double found = error(candidate);
    if (found <= settings.max_error) {
      good = faces;
      best = candidate;
    } else {
      bad = std::max(bad, faces);
    }
    guess = faces * found / settings.max_error;
    if (i % 2 == 1 || guess >= good || guess <= bad) guess = std::sqrt(good * bad);
  }
  return best;
}

}  // namespace

TriangleMesh reduce_to_faces(const TriangleMesh& manifold, const SimplifySettings& settings,
                             std::span<const double> vertex_weights, const ProgressFunction& progress) {
  const bool fits = settings.quality == SimplifyQuality::best;
  const CollapseSequence sequence =
      collapse(manifold, settings, settings.faces, false, vertex_weights, part(progress, 0, fits ? 0.1 : 1));
  const std::size_t count = sequence.collapses.size();
  return fits ? fitted(sequence, count, settings.crease, part(progress, 0.1, 1)) : sequence.after(count);
}

TriangleMesh reduce_to_error(const TriangleMesh& manifold, const SimplifySettings& settings,
                             const CandidateError& error, std::span<const double> vertex_weights,
                             const ProgressFunction& progress) {
  // Where standard's steps are to begin, a draft says.
  int faces = 4;
  if (settings.quality == SimplifyQuality::standard) {
    SimplifySettings draft = settings;
    draft.quality = SimplifyQuality::draft;
    const CollapseSequence sequence = collapse(manifold, draft, 4, true, vertex_weights, part(progress, 0, 0.1));
    faces = sequence.faces_after(count_within(sequence, settings.max_error, error, part(progress, 0.1, 0.3)));
  }
  const bool fits = settings.quality == SimplifyQuality::best;
  const CollapseSequence sequence =
      collapse(manifold, settings, faces, true, vertex_weights, part(progress, 0.3, fits ? 0.4 : 0.7));
  const std::size_t count =
      count_within(sequence, settings.max_error, error, part(progress, fits ? 0.4 : 0.7, fits ? 0.5 : 1));
  return fits ? fitted_within(sequence, count, settings, error, part(progress, 0.5, 1)) : sequence.after(count);
}

}  // namespace kiln
