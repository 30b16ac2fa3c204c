// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/reduce.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "simplify/cgal_collapse.h"
#include "simplify/collapse.h"
#include "simplify/feature_edges.h"
#include "simplify/fit.h"

namespace kiln {

namespace {

/// Stages of a collapse, as multiples of the triangles wanted. `standard` collapses by quick quadrics down to
/// quick_times of them, then by collapse_edges. From compared_times of them on, triangles are compared with the
/// input's surface.
constexpr int quick_times = 3, compared_times = 3;

int times(int factor, int faces) {
  return static_cast<int>(std::min<long long>(static_cast<long long>(factor) * faces, std::numeric_limits<int>::max()));
}

/// Reduction of one input, with what is known of it.
class Reducer {
 public:
  Reducer(const TriangleMesh& manifold, const SimplifySettings& settings, const CandidateDistance& distance,
          std::span<const double> vertex_weights, const FeatureLines& lines)
      : manifold_(manifold),
        settings_(settings),
        distance_(distance),
        vertex_weights_(vertex_weights),
        given_(lines.hard),
        hard_(lines.hard) {
    given_.insert(given_.end(), lines.smooth.begin(), lines.smooth.end());
  }

  Reduced to_faces(const ProgressFunction& progress) const {
    if (quality() == SimplifyQuality::best) return best_to_faces(progress);
    return unfitted_to_faces(quality(), progress);
  }

  Reduced to_error(const ProgressFunction& progress) const {
    // Find where standard's steps are to begin, by a draft.
    int faces = 4;
    if (quality() == SimplifyQuality::standard && settings_.engine == SimplifyEngine::kiln) {
      const CollapseSequence sequence = collapse(SimplifyQuality::draft, 4, true, part_of(progress, 0, 0.1));
      faces = sequence.faces_after(count_within(sequence, part_of(progress, 0.1, 0.3)));
    }
    const bool fits = quality() == SimplifyQuality::best;
    const CollapseSequence sequence = collapse(quality(), faces, true, part_of(progress, 0.3, fits ? 0.4 : 0.7));
    const std::size_t count = count_within(sequence, part_of(progress, fits ? 0.4 : 0.7, fits ? 0.5 : 1));
    return fits ? fitted_within(sequence, count, part_of(progress, 0.5, 1)) : unfitted(sequence, count);
  }

 private:
  /// Returns the quality asked for; of CGAL's engine there is but one, which is not fitted.
  SimplifyQuality quality() const {
    return settings_.engine == SimplifyEngine::cgal ? SimplifyQuality::standard : settings_.quality;
  }

  Reduced unfitted_to_faces(SimplifyQuality quality, const ProgressFunction& progress) const {
    const CollapseSequence sequence = collapse(quality, settings_.faces, false, progress);
    return unfitted(sequence, careful_count(sequence));
  }

  /// Returns how many collapses to do: all where they get to settings.faces. Where they do not, those with wider limits
  /// spoil the shape for nothing and are left out, unless they save a fifth of the triangles.
  std::size_t careful_count(const CollapseSequence& sequence) const {
    const std::size_t all = sequence.collapses.size(), close = sequence.close_count;
    if (sequence.faces_after(all) <= settings_.faces) return all;
    return 0.8 * sequence.faces_after(close) <= sequence.faces_after(all) ? close : all;
  }

  /// Returns the fitted mesh. Where a draft has a smaller distance, returns the candidate of least RMS whose Hausdorff
  /// distance is no larger than the draft's: unfitted, standard, fitted from either, or the draft itself. So best is
  /// never worse than draft.
  Reduced best_to_faces(const ProgressFunction& progress) const {
    const CollapseSequence sequence =
        collapse(SimplifyQuality::best, settings_.faces, false, part_of(progress, 0, 0.1));
    const std::size_t count = careful_count(sequence);
    Reduced result = fitted(sequence, count, part_of(progress, 0.1, 0.8));
    const CollapseSequence draft_sequence =
        collapse(SimplifyQuality::draft, settings_.faces, false, part_of(progress, 0.8, 0.85));
    const std::size_t draft_count = careful_count(draft_sequence);
    Reduced draft = unfitted(draft_sequence, draft_count);
    const std::size_t most_faces = std::max(static_cast<std::size_t>(settings_.faces), result.mesh.triangles.size());
    if (draft.mesh.triangles.size() > most_faces) return result;
    const MeshDistance bound = distance_(draft.mesh), found = distance_(result.mesh);
    if (found.hausdorff <= bound.hausdorff && found.rms <= bound.rms) return result;

    double least = found.hausdorff <= bound.hausdorff ? found.rms : std::numeric_limits<double>::infinity();
    const auto consider = [&](Reduced candidate) {
      if (candidate.mesh.triangles.size() > most_faces) return;
      const MeshDistance distance = distance_(candidate.mesh);
      if (distance.hausdorff > bound.hausdorff || !(distance.rms < least)) return;
      least = distance.rms;
      result = std::move(candidate);
    };
    const CollapseSequence standard_sequence =
        collapse(SimplifyQuality::standard, settings_.faces, false, part_of(progress, 0.85, 0.87));
    const std::size_t standard_count = careful_count(standard_sequence);
    consider(unfitted(sequence, count));
    consider(unfitted(standard_sequence, standard_count));
    consider(fitted(standard_sequence, standard_count, part_of(progress, 0.87, 0.93)));
    consider(fitted(draft_sequence, draft_count, part_of(progress, 0.93, 1)));
    consider(std::move(draft));
    return result;
  }

  /// Collapses for a result of about `faces`, on to the last that is possible where `goes_on`.
  CollapseSequence collapse(SimplifyQuality quality, int faces, bool goes_on, const ProgressFunction& progress) const {
    CollapseSettings collapse;
    collapse.faces = goes_on ? 4 : faces;
    collapse.crease_degrees = settings_.crease;
    collapse.feature_edges = given_;
    collapse.vertex_weights = vertex_weights_;
    if (settings_.engine == SimplifyEngine::cgal)
      return collapse_by_cgal(manifold_, collapse, {settings_.cost, settings_.max_normal_change, settings_.envelope},
                              progress);
    switch (quality) {
      case SimplifyQuality::draft:
        return collapse_edges_in_two_steps(manifold_, collapse.faces, collapse, progress);
      case SimplifyQuality::standard:
        collapse.compared_faces = times(compared_times, faces);
        return collapse_edges_in_two_steps(manifold_, times(quick_times, faces), collapse, progress);
      case SimplifyQuality::best:
        break;
    }
    return collapse_edges(manifold_, collapse, progress);
  }

  Reduced unfitted(const CollapseSequence& sequence, std::size_t count) const {
    return {sequence.after(count), surviving_edges(sequence, count, hard_), sequence.met_envelope};
  }

  /// Fits the mesh after `count` collapses to the start. Vertices of feature edges stay.
  Reduced fitted(const CollapseSequence& sequence, std::size_t count, const ProgressFunction& progress) const {
    std::vector<std::uint32_t> origins;
    const TriangleMesh low = sequence.after(count, &origins);
    if (count == 0) return unfitted(sequence, count);
    std::vector<std::uint8_t> in_feature(sequence.start.positions.size(), 0);
    for (const auto& [a, b] : find_feature_edges(sequence.start, settings_.crease, given_))
      in_feature[a] = in_feature[b] = 1;
    // Fix the vertices of feature edges. A collapse keeps such a vertex rather than one of no feature edge, so that
    // origins tell which they are.
    std::vector<std::uint8_t> is_fixed;
    for (std::uint32_t origin : origins) is_fixed.push_back(in_feature[origin]);
    return {fit_to_surface(low, sequence.start, is_fixed, {}, progress), surviving_edges(sequence, count, hard_),
            false};
  }

  /// Finds the most collapses that keep within max_error, to 1 % in the number of triangles, by bisection.
  std::size_t count_within(const CollapseSequence& sequence, const ProgressFunction& progress) const {
    const auto faces_after = [&](std::size_t count) { return static_cast<double>(sequence.faces_after(count)); };
    const auto within = [&](std::size_t count) {
      return distance_(sequence.after(count)).hausdorff <= settings_.max_error;
    };
    std::size_t good = 0, bad = sequence.collapses.size();
    if (bad == 0 || within(bad)) return bad;
    const double start_gap = std::log(faces_after(good) / faces_after(bad));
    for (double gap = start_gap; bad - good > 1 && gap > 0.01; gap = std::log(faces_after(good) / faces_after(bad))) {
      progress(std::clamp(1 - std::log(gap / 0.01) / std::log(start_gap / 0.01), 0.0, 1.0));
      // Halve the logarithm of the number of triangles: errors grow by its powers.
      const double wanted = std::sqrt(faces_after(good) * faces_after(bad));
      const std::size_t middle = std::clamp(sequence.count_for(static_cast<int>(wanted)), good + 1, bad - 1);
      (within(middle) ? good : bad) = middle;
    }
    return good;
  }

  /// Finds the fitted mesh of the fewest triangles within max_error. Fits take long, so each is made where the last
  /// ones say that the bound is: the error goes with the area of a triangle.
  Reduced fitted_within(const CollapseSequence& sequence, std::size_t unfitted_count,
                        const ProgressFunction& progress) const {
    constexpr int most_fits = 8;
    Reduced best = unfitted(sequence, unfitted_count);
    double good = sequence.faces_after(unfitted_count), bad = 4, guess = 0.7 * good;
    for (int i = 0; i < most_fits && good > 1.01 * bad; ++i) {
      const std::size_t count = sequence.count_for(static_cast<int>(std::lround(guess)));
      const double faces = sequence.faces_after(count);
      if (!(faces < good)) break;
      Reduced candidate =
          fitted(sequence, count, part_of(progress, static_cast<double>(i) / most_fits, (i + 1.0) / most_fits));
      const double found = distance_(candidate.mesh).hausdorff;
      if (found <= settings_.max_error) {
        good = faces;
        best = std::move(candidate);
      } else {
        bad = std::max(bad, faces);
      }
      guess = faces * found / settings_.max_error;
      if (i % 2 == 1 || guess >= good || guess <= bad) guess = std::sqrt(good * bad);
    }
    return best;
  }

  const TriangleMesh& manifold_;
  const SimplifySettings& settings_;
  const CandidateDistance& distance_;
  std::span<const double> vertex_weights_;
  std::vector<VertexPair> given_;  ///< feature edges of the input
  std::vector<VertexPair> hard_;   ///< those of them that are shaded as edges
};

}  // namespace

Reduced reduce_to_faces(const TriangleMesh& manifold, const SimplifySettings& settings,
                        const CandidateDistance& distance, std::span<const double> vertex_weights,
                        const FeatureLines& lines, const ProgressFunction& progress) {
  return Reducer(manifold, settings, distance, vertex_weights, lines).to_faces(progress);
}

Reduced reduce_to_error(const TriangleMesh& manifold, const SimplifySettings& settings,
                        const CandidateDistance& distance, std::span<const double> vertex_weights,
                        const FeatureLines& lines, const ProgressFunction& progress) {
  return Reducer(manifold, settings, distance, vertex_weights, lines).to_error(progress);
}

}  // namespace kiln
