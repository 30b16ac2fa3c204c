// SPDX-License-Identifier: GPL-3.0-or-later
// Energy and line search: [Smith 2015]. Reweighted proxies: [Rabinovich 2017].
#include "atlas/relax.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "atlas/block_cholesky.h"

namespace kiln {

namespace {

using Matrix2 = Eigen::Matrix2d;
using Uvs = std::vector<Eigen::Vector2d>;

Matrix2 jacobian(const RestTriangle& rest, const Triangle& t, const Uvs& uvs) {
  return uvs[t[0]] * rest.gradients[0].transpose() + uvs[t[1]] * rest.gradients[1].transpose() +
         uvs[t[2]] * rest.gradients[2].transpose();
}

/// Singular values and the nearest rotation of a 2x2 matrix with positive determinant.
struct Decomposition {
  double larger, smaller;
  Matrix2 rotation;
};

Decomposition decompose(const Matrix2& j) {
  const double e = 0.5 * (j(0, 0) + j(1, 1)), f = 0.5 * (j(0, 0) - j(1, 1));
  const double g = 0.5 * (j(1, 0) + j(0, 1)), h = 0.5 * (j(1, 0) - j(0, 1));
  const double q = std::hypot(e, h), r = std::hypot(f, g);
  Decomposition d{q + r, q - r, {}};
  d.rotation << e, -h, h, e;
  d.rotation /= q;
  return d;
}

/// Returns the squared weight of the proxy for one singular value: with it, weight^2 (s - 1)^2 has the energy's
/// gradient.
double proxy_weight(double s) { return (s + 1) * (s * s + 1) / (s * s * s); }

/// Returns the proxy's metric. It has the left singular vectors of j, so it is a combination of the identity and j j^T.
Matrix2 proxy_metric(const Matrix2& j, const Decomposition& d) {
  const double weight_larger = proxy_weight(d.larger), weight_smaller = proxy_weight(d.smaller);
  const double gap = d.larger * d.larger - d.smaller * d.smaller;
  const double slope = gap > 1e-9 ? (weight_larger - weight_smaller) / gap : 0;
  return (weight_larger - slope * d.larger * d.larger) * Matrix2::Identity() + slope * j * j.transpose();
}

/// Returns the largest step along `move` before a triangle loses its area.
double largest_step(const Chart& chart, const Uvs& uvs, const Uvs& move) {
  double largest = std::numeric_limits<double>::infinity();
  for (const Triangle& t : chart.triangles) {
    const Eigen::Vector2d p = uvs[t[1]] - uvs[t[0]], q = uvs[t[2]] - uvs[t[0]];
    const Eigen::Vector2d dp = move[t[1]] - move[t[0]], dq = move[t[2]] - move[t[0]];
    const auto det = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); };
    // Area is a quadratic of the step; take its smallest positive root, in the form that does not cancel.
    const double a = det(dp, dq), b = det(p, dq) + det(dp, q), c = det(p, q);
    const double discriminant = b * b - 4 * a * c;
    if (discriminant < 0) continue;
    const double sum = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    for (const double root : {sum / a, c / sum})
      if (root > 0 && root < largest) largest = root;
  }
  return largest;
}

double mean_energy(const Surface& surface, const Chart& chart, const Uvs& uvs) {
  double sum = 0, area = 0;
  for (std::size_t i = 0; i < chart.triangles.size(); ++i) {
    const RestTriangle& rest = surface.rest[chart.faces[i]];
    const Matrix2 j = jacobian(rest, chart.triangles[i], uvs);
    const double determinant = j.determinant();
    if (!(determinant > 0)) return std::numeric_limits<double>::infinity();
    const double square = j.squaredNorm();
    sum += rest.area * square * (1 + 1 / (determinant * determinant));
    area += rest.area;
  }
  return sum / area;
}

/// Least squares systems of a chart's steps; they all have the same pattern.
class Relaxation {
 public:
  /// Vertices that are `pinned`, if any are given, do not move.
  Relaxation(const Surface& surface, Chart& chart, std::vector<std::uint8_t> pinned = {})
      : surface_(surface), chart_(chart), pinned_(std::move(pinned)), solver_(chart.uvs.size(), number_edges()) {
    pinned_.resize(chart.uvs.size(), 0);
    diagonal_.resize(chart.uvs.size());
    off_diagonal_.resize(edge_count_);
    right_side_.resize(chart.uvs.size());
  }

  double energy(const Uvs& uvs) const { return mean_energy(surface_, chart_, uvs); }

  /// Runs as-rigid-as-possible steps [Liu 2008], which need no valid start, until nothing is flipped.
  bool unflip(int iterations) {
    for (int i = 0; i < iterations; ++i) {
      assemble(true);
      if (i == 0 && !solver_.factorise(diagonal_, off_diagonal_))
        return false;  // later steps change only the right side
      const Uvs solution = solver_.solve(right_side_);
      if (!all_finite(solution)) return false;
      for (std::size_t v = 0; v < chart_.uvs.size(); ++v)
        if (!pinned_[v]) chart_.uvs[v] = solution[v];
      if (is_flip_free(chart_)) return true;
    }
    return false;
  }

  /// Makes one step; returns the new energy, or the old one where it cannot be lowered.
  double step(double old_energy) {
    assemble(false);
    if (!solver_.factorise(diagonal_, off_diagonal_)) return old_energy;
    Uvs move = solver_.solve(right_side_);
    if (!all_finite(move)) return old_energy;
    for (std::size_t v = 0; v < move.size(); ++v)
      move[v] = pinned_[v] ? Eigen::Vector2d(0, 0) : Eigen::Vector2d(move[v] - chart_.uvs[v]);

    double length = std::min(1.0, 0.8 * largest_step(chart_, chart_.uvs, move));
    Uvs trial(move.size());
    for (int halvings = 0; halvings < 20; ++halvings, length *= 0.5) {
      for (std::size_t v = 0; v < move.size(); ++v) trial[v] = chart_.uvs[v] + length * move[v];
      const double new_energy = energy(trial);
      if (new_energy < old_energy) {
        chart_.uvs = std::move(trial);
        return new_energy;
      }
    }
    return old_energy;
  }

 private:
  static bool all_finite(const Uvs& uvs) {
    return std::all_of(uvs.begin(), uvs.end(), [](const Eigen::Vector2d& uv) { return uv.allFinite(); });
  }

  /// Numbers the edges and records which ones a triangle has.
  std::vector<BlockCholesky::Edge> number_edges() {
    // Keep, per vertex, its edges to vertices of higher numbers: few enough for a linear search.
    std::vector<std::uint32_t> offsets(chart_.uvs.size() + 1, 0);
    const auto edge_of = [](const Triangle& t, int k) -> BlockCholesky::Edge {
      return std::minmax(t[k], t[(k + 1) % 3]);
    };
    for (const Triangle& t : chart_.triangles)
      for (int k = 0; k < 3; ++k) ++offsets[edge_of(t, k).first + 1];
    for (std::size_t v = 0; v < chart_.uvs.size(); ++v) offsets[v + 1] += offsets[v];
    std::vector<std::uint32_t> others(offsets.back()), numbers(offsets.back());
    std::vector<std::uint32_t> ends(offsets.begin(), offsets.end() - 1);

    std::vector<BlockCholesky::Edge> edges;
    edges_of_triangles_.resize(chart_.triangles.size());
    for (std::size_t i = 0; i < chart_.triangles.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const BlockCholesky::Edge edge = edge_of(chart_.triangles[i], k);
        std::uint32_t at = offsets[edge.first];
        while (at < ends[edge.first] && others[at] != edge.second) ++at;
        if (at == ends[edge.first]) {
          ++ends[edge.first];
          others[at] = edge.second;
          numbers[at] = static_cast<std::uint32_t>(edges.size());
          edges.push_back(edge);
        }
        edges_of_triangles_[i][k] = numbers[at];
      }
    edge_count_ = edges.size();
    return edges;
  }

  /// Assembles the quadratic proxy around the present uvs; `rigid` weighs all directions alike.
  void assemble(bool rigid) {
    for (std::size_t v = 0; v < chart_.uvs.size(); ++v) {
      const double proximal = pinned_[v] ? 1e9 : 1e-5;  // 1e-5 fixes the translation
      diagonal_[v] = {proximal, 0, proximal};
      right_side_[v] = proximal * chart_.uvs[v];
    }
    std::fill(off_diagonal_.begin(), off_diagonal_.end(), SymmetricBlock{});
    for (std::size_t i = 0; i < chart_.triangles.size(); ++i) {
      const Triangle& t = chart_.triangles[i];
      const RestTriangle& rest = surface_.rest[chart_.faces[i]];
      const Matrix2 j = jacobian(rest, t, chart_.uvs);
      const Decomposition d = decompose(j);
      const Matrix2 metric = rest.area * (rigid ? Matrix2(Matrix2::Identity()) : proxy_metric(j, d));
      const SymmetricBlock block{metric(0, 0), metric(0, 1), metric(1, 1)};
      const Matrix2 goal = metric * d.rotation;
      for (int k = 0; k < 3; ++k) {
        diagonal_[t[k]].add(rest.gradients[k].squaredNorm(), block);
        off_diagonal_[edges_of_triangles_[i][k]].add(rest.gradients[k].dot(rest.gradients[(k + 1) % 3]), block);
        right_side_[t[k]] += goal * rest.gradients[k];
      }
    }
  }

  const Surface& surface_;
  Chart& chart_;
  std::vector<std::uint8_t> pinned_;
  std::vector<std::array<std::uint32_t, 3>> edges_of_triangles_;  ///< edge k goes from corner k to the next
  std::size_t edge_count_ = 0;
  BlockCholesky solver_;
  std::vector<SymmetricBlock> diagonal_, off_diagonal_;
  Uvs right_side_;
};

/// Part of a chart, with its own copy of the uvs.
struct Region {
  Chart chart;
  std::vector<std::uint32_t> vertices;  ///< per vertex of the part: the vertex of the whole
  std::vector<std::uint8_t> pinned;     ///< per vertex of the part: it has triangles outside the part
};

/// Collects triangles ring by ring around the seeds until there are enough.
Region region_around(const Chart& whole, const std::vector<std::uint32_t>& seeds, std::size_t most_faces) {
  const std::size_t vertex_count = whole.uvs.size();
  std::vector<std::uint32_t> offsets(vertex_count + 1, 0);
  for (const Triangle& t : whole.triangles)
    for (const std::uint32_t corner : t) ++offsets[corner + 1];
  for (std::size_t v = 0; v < vertex_count; ++v) offsets[v + 1] += offsets[v];
  std::vector<std::uint32_t> triangles_at(offsets.back()), filled(offsets.begin(), offsets.end() - 1);
  for (std::uint32_t i = 0; i < whole.triangles.size(); ++i)
    for (const std::uint32_t corner : whole.triangles[i]) triangles_at[filled[corner]++] = i;

  std::vector<std::uint8_t> taken(whole.triangles.size(), 0);
  std::vector<std::uint32_t> index(vertex_count, no_index);
  Region region;
  const auto add_vertex = [&](std::uint32_t v) {
    if (index[v] != no_index) return;
    index[v] = static_cast<std::uint32_t>(region.vertices.size());
    region.vertices.push_back(v);
  };
  for (const std::uint32_t seed : seeds) add_vertex(seed);
  for (std::size_t front = 0; front < region.vertices.size() && region.chart.faces.size() < most_faces; ++front) {
    const std::uint32_t v = region.vertices[front];
    for (std::uint32_t i = offsets[v]; i < offsets[v + 1]; ++i) {
      const std::uint32_t triangle = triangles_at[i];
      if (taken[triangle]) continue;
      taken[triangle] = 1;
      region.chart.faces.push_back(whole.faces[triangle]);
      for (const std::uint32_t corner : whole.triangles[triangle]) add_vertex(corner);
      Triangle local = whole.triangles[triangle];
      for (std::uint32_t& corner : local) corner = index[corner];
      region.chart.triangles.push_back(local);
    }
  }
  for (const std::uint32_t v : region.vertices) {
    region.chart.vertices.push_back(whole.vertices[v]);
    region.chart.uvs.push_back(whole.uvs[v]);
    const auto first = triangles_at.begin() + offsets[v], last = triangles_at.begin() + offsets[v + 1];
    region.pinned.push_back(std::any_of(first, last, [&](std::uint32_t triangle) { return !taken[triangle]; }));
  }
  return region;
}

double run(Relaxation& relaxation, const Chart& chart, const RelaxSettings& settings) {
  constexpr double isometry = 4;
  double energy = relaxation.energy(chart.uvs);
  for (int i = 0; i < settings.iterations; ++i) {
    const double old_energy = energy;
    energy = relaxation.step(old_energy);
    if (old_energy - energy <= settings.tolerance * (old_energy - isometry) || energy - isometry < 1e-9) break;
  }
  return energy;
}

}  // namespace

double relax(const Surface& surface, Chart& chart, const RelaxSettings& settings) {
  Relaxation relaxation(surface, chart);
  return run(relaxation, chart, settings);
}

bool relax_until(const Surface& surface, Chart& chart, const std::function<bool(double)>& goes_on) {
  std::optional<Relaxation> relaxation;  // made when a step is needed
  if (!is_flip_free(chart)) {
    relaxation.emplace(surface, chart);
    if (!relaxation->unflip(6)) return false;
  }
  for (double energy = mean_energy(surface, chart, chart.uvs); goes_on(energy);) {
    if (!relaxation) relaxation.emplace(surface, chart);
    const double lower = relaxation->step(energy);
    if (!(lower < energy)) break;
    energy = lower;
  }
  return true;
}

bool relax_around(const Surface& surface, Chart& chart, const std::vector<std::uint32_t>& seeds, std::size_t most_faces,
                  const RelaxSettings& settings) {
  Region region = region_around(chart, seeds, most_faces);
  Relaxation relaxation(surface, region.chart, region.pinned);
  if (!is_flip_free(region.chart) && !relaxation.unflip(6)) return false;
  run(relaxation, region.chart, settings);
  for (std::size_t v = 0; v < region.vertices.size(); ++v) chart.uvs[region.vertices[v]] = region.chart.uvs[v];
  return true;
}

}  // namespace kiln
