// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/fit.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "mesh/nearest_surface.h"
#include "simplify/thinnest_heights.h"
#include "simplify/triangle_shape.h"
#include "simplify/unit_frame.h"

namespace kiln {

namespace {

using Vector = Eigen::Vector3d;
using Matrix9 = Eigen::Matrix<double, 9, 9>;
using Vector9 = Eigen::Matrix<double, 9, 1>;

/// Returns the mesh with its positions in `frame`.
TriangleMesh in_frame(const TriangleMesh& mesh, const UnitFrame& frame) {
  TriangleMesh result;
  result.triangles = mesh.triangles;
  for (const Eigen::Vector3f& p : mesh.positions) result.positions.emplace_back(frame.from_object(p).cast<float>());
  return result;
}

/// Returns a number in [0, 1) for each i: the fractional parts of multiples of roots [Roberts 2018].
double quasi_random(std::size_t i, double step) {
  const double x = 0.5 + static_cast<double>(i + 1) * step;
  return x - std::floor(x);
}

/// Point of a triangle, in double precision.
struct TrianglePoint {
  std::uint32_t triangle;
  Vector weights;  ///< barycentric, of the triangle's corners
};

/// Spreads `samples` points over a mesh, each for the same area.
std::vector<TrianglePoint> spread(const TriangleMesh& mesh, int samples) {
  std::vector<double> area_up_to;
  double area = 0;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3f &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    area += (b - a).cross(c - a).cast<double>().norm();
    area_up_to.push_back(area);
  }
  std::vector<TrianglePoint> points;
  std::uint32_t triangle = 0;
  for (int i = 0; i < samples; ++i) {
    while (triangle + 1 < mesh.triangles.size() && area_up_to[triangle] < (i + 0.5) / samples * area) ++triangle;
    double u = quasi_random(static_cast<std::size_t>(i), 0.7548776662466927),
           v = quasi_random(static_cast<std::size_t>(i), 0.5698402909980532);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    points.push_back({triangle, {1 - u - v, u, v}});
  }
  return points;
}

Vector barycentric(const Vector& p, const Vector& a, const Vector& b, const Vector& c) {
  const Vector ab = b - a, ac = c - a, ap = p - a;
  const double bb = ab.squaredNorm(), bc = ab.dot(ac), cc = ac.squaredNorm(), determinant = bb * cc - bc * bc;
  if (!(determinant > 0)) return Vector::Constant(1.0 / 3);
  const double v = (cc * ap.dot(ab) - bc * ap.dot(ac)) / determinant,
               w = (bb * ap.dot(ac) - bc * ap.dot(ab)) / determinant;
  return {1 - v - w, v, w};
}

/// Pair of a point of the low mesh and the point of the high one that it is to come close to.
struct Pair {
  TrianglePoint low;
  Vector high;
  Vector direction;     ///< unit vector along which the gap is to be closed
  double distance = 0;  ///< between the two points
  double nearest = 0;   ///< distance from the sample to the other surface, whichever way that faces
};

/// Distances between the two surfaces.
struct Error {
  double rms = 0, largest = 0;
};

/// Returns how many samples a surface gets: enough for each triangle of either, at most 100,000 or 10 per low triangle.
int sample_count(const TriangleMesh& low, const TriangleMesh& high, const FitSettings& settings) {
  if (settings.samples > 0) return settings.samples;
  const std::size_t wanted = std::max(20 * low.triangles.size(), 2 * high.triangles.size());
  return static_cast<int>(
      std::clamp<std::size_t>(wanted, 5'000, std::max<std::size_t>(100'000, 10 * low.triangles.size())));
}

/// Returns the triangles' normals, as long as twice their areas.
std::vector<Vector> triangle_normals(const TriangleMesh& mesh) {
  std::vector<Vector> normals;
  for (const Triangle& triangle : mesh.triangles) normals.push_back(area_normal(mesh, triangle));
  return normals;
}

class Fit {
 public:
  Fit(const TriangleMesh& low, const TriangleMesh& high, std::span<const std::uint8_t> is_fixed,
      const FitSettings& settings)
      : settings_(settings),
        sample_count_(sample_count(low, high, settings)),
        frame_(high),
        high_(in_frame(high, frame_)),
        surface_(high_),
        is_fixed_(is_fixed),
        thinnest_(thinnest_heights(low, frame_.diagonal)) {
    for (const Eigen::Vector3f& p : low.positions) positions_.push_back(frame_.from_object(p));
    triangles_ = low.triangles;
    // Sample the high mesh: points inside its triangles, then its vertices, or every n-th of very many.
    const std::vector<Vector> normals = triangle_normals(high_);
    for (const TrianglePoint& point : spread(high_, sample_count_)) {
      sample_normals_.push_back(normals[point.triangle]);
      Vector p = Vector::Zero();
      for (int k = 0; k < 3; ++k)
        p += point.weights[k] * high_.positions[high_.triangles[point.triangle][k]].cast<double>();
      samples_.push_back(p);
    }
    std::vector<Vector> vertex_normals(high_.positions.size(), Vector::Zero());
    for (std::size_t i = 0; i < high_.triangles.size(); ++i)
      for (std::uint32_t vertex : high_.triangles[i]) vertex_normals[vertex] += normals[i];
    const std::size_t step = 1 + vertex_normals.size() / (2 * static_cast<std::size_t>(sample_count_));
    for (std::size_t i = 0; i < vertex_normals.size(); i += step) {
      if (!(vertex_normals[i].squaredNorm() > 0)) continue;
      samples_.emplace_back(high_.positions[i].cast<double>());
      sample_normals_.push_back(vertex_normals[i]);
    }
    sample_hints_.resize(samples_.size(), 0);
    const double mean_area =
        surface_area(low) / (frame_.diagonal * frame_.diagonal) / static_cast<double>(triangles_.size());
    reach_ = 0.25 * std::sqrt(mean_area * 4 / std::sqrt(3.0));
  }

  TriangleMesh run(const TriangleMesh& low, const ProgressFunction& progress) {
    pair_up();
    const Error first = error();
    TriangleMesh best = low;
    double best_score = 1;
    for (int round = 0; round < settings_.rounds; ++round) {
      progress(static_cast<double>(round) / settings_.rounds);
      const double share = static_cast<double>(round) / settings_.rounds;
      if (round % 2 == 1) flip_edges(exponent(share));
      move_vertices(exponent(share));
      pair_up();
      const Error now = error();
      const double score = std::sqrt(now.rms / first.rms * now.largest / first.largest);
      if (now.rms <= first.rms && score < best_score) {
        best_score = score;
        best.triangles = triangles_;
        for (std::size_t i = 0; i < positions_.size(); ++i)
          best.positions[i] = is_fixed_[i] ? low.positions[i] : frame_.to_object(positions_[i]).cast<float>().eval();
      }
    }
    return best;
  }

 private:
  /// Returns the power of the distance that a sample's weight goes with: 0 first, to bring the mean down, then 2.5, for
  /// the largest.
  static double exponent(double share) { return share < 0.3 ? 0 : 2.5; }

  TriangleMesh low_mesh() const {
    TriangleMesh mesh;
    mesh.triangles = triangles_;
    for (const Vector& p : positions_) mesh.positions.emplace_back(p.cast<float>());
    return mesh;
  }

  Vector point_of(const TrianglePoint& point) const {
    const Triangle& t = triangles_[point.triangle];
    return point.weights[0] * positions_[t[0]] + point.weights[1] * positions_[t[1]] +
           point.weights[2] * positions_[t[2]];
  }
  TriangleShape shape_of(const Triangle& t) const { return {positions_[t[0]], positions_[t[1]], positions_[t[2]]}; }

  /// Finds the nearest point that faces as `normal` does, or, where none is within reach, returns `hit`, the nearest of
  /// all. On a wall that is thinner than the error, that may lie on the other side.
  NearestSurface::Hit facing(const NearestSurface& surface, const Vector& point, const Vector& normal,
                             const NearestSurface::Hit& hit) const {
    if (surface.normal(hit).dot(normal) >= 0) return hit;
    return surface.nearest_facing(point, {normal, 0, std::sqrt(hit.squared_distance) + reach_}, hit.hint).value_or(hit);
  }

  /// Pairs each sample of either surface with the nearest point of the other.
  void pair_up() {
    const TriangleMesh low = low_mesh();
    const NearestSurface low_surface(low);
    from_high_.resize(samples_.size());
    constexpr std::size_t chunk = 512;
    const auto in_chunks = [&](std::size_t size, const auto& work) {
      parallel_for(std::size_t{0}, (size + chunk - 1) / chunk, [&](std::size_t c) {
        for (std::size_t i = c * chunk; i < std::min(size, (c + 1) * chunk); ++i) work(i);
      });
    };
    in_chunks(samples_.size(), [&](std::size_t i) {
      const NearestSurface::Hit nearest = low_surface.nearest(samples_[i], sample_hints_[i]);
      const NearestSurface::Hit hit = facing(low_surface, samples_[i], sample_normals_[i], nearest);
      sample_hints_[i] = hit.hint;
      const Triangle& t = triangles_[hit.triangle];
      Pair& pair = from_high_[i];
      pair.low = {hit.triangle, barycentric(hit.point, positions_[t[0]], positions_[t[1]], positions_[t[2]])};
      pair.high = samples_[i];
      pair.distance = std::sqrt(hit.squared_distance);
      pair.nearest = std::sqrt(nearest.squared_distance);
      pair.direction =
          pair.distance > 1e-7 ? ((samples_[i] - hit.point) / pair.distance).eval() : low_surface.normal(hit);
    });

    low_samples_ = spread(low, sample_count_);
    // Add vertices and points of edges: where the surface curves outwards, vertices are the farthest from it; inwards,
    // edges are.
    std::vector<bool> seen(positions_.size(), false);
    for (std::uint32_t i = 0; i < triangles_.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t vertex = triangles_[i][k], next = triangles_[i][(k + 1) % 3];
        if (!seen[vertex]) low_samples_.push_back({i, Vector::Unit(k)});
        seen[vertex] = true;
        if (vertex < next)
          for (const double at : {0.25, 0.5, 0.75})
            low_samples_.push_back({i, (1 - at) * Vector::Unit(k) + at * Vector::Unit((k + 1) % 3)});
      }
    const std::vector<Vector> normals = triangle_normals(low);
    from_low_.resize(low_samples_.size());
    low_hints_.resize(low_samples_.size(), 0);
    in_chunks(from_low_.size(), [&](std::size_t i) {
      Pair& pair = from_low_[i];
      pair.low = low_samples_[i];
      const Vector point = point_of(pair.low);
      const NearestSurface::Hit nearest = surface_.nearest(point, low_hints_[i]);
      const NearestSurface::Hit hit = facing(surface_, point, normals[pair.low.triangle], nearest);
      low_hints_[i] = hit.hint;
      pair.high = hit.point;
      pair.distance = std::sqrt(hit.squared_distance);
      pair.nearest = std::sqrt(nearest.squared_distance);
      pair.direction = pair.distance > 1e-7 ? ((point - hit.point) / pair.distance).eval() : surface_.normal(hit);
    });
  }

  Error error() const {
    Error error;
    for (const auto& [pairs, spread_samples] : {std::pair(&from_high_, static_cast<std::size_t>(sample_count_)),
                                                std::pair(&from_low_, static_cast<std::size_t>(sample_count_))}) {
      double sum = 0;
      for (std::size_t i = 0; i < pairs->size(); ++i) {
        const double distance = (*pairs)[i].nearest;
        if (i < spread_samples) sum += distance * distance;
        error.largest = std::max(error.largest, distance);
      }
      error.rms = std::max(error.rms, std::sqrt(sum / static_cast<double>(spread_samples)));
    }
    return error;
  }

  static double weight_of(double distance, double rms, double exponent) {
    return std::pow(0.1 + distance / rms, exponent);
  }

  void move_vertices(double exponent) {
    // Sum the normal equations by triangle.
    std::vector<Matrix9> matrices(triangles_.size(), Matrix9::Zero());
    std::vector<Vector9> right(triangles_.size(), Vector9::Zero());
    const double rms = error().rms;
    for (const auto* pairs : {&from_high_, &from_low_}) {
      const double share = 1.0 / static_cast<double>(pairs->size());
      for (const Pair& pair : *pairs) {
        Vector9 row;
        for (int k = 0; k < 3; ++k) row.segment<3>(3 * k) = pair.low.weights[k] * pair.direction;
        const double weight = share * weight_of(pair.distance, rms, exponent);
        const double residual = pair.direction.dot(pair.high - point_of(pair.low));
        matrices[pair.low.triangle].noalias() += weight * row * row.transpose();
        right[pair.low.triangle] += weight * residual * row;
      }
    }

    std::vector<int> unknown(positions_.size(), -1);
    int unknowns = 0;
    for (std::size_t i = 0; i < positions_.size(); ++i)
      if (!is_fixed_[i]) unknown[i] = unknowns++;
    if (unknowns == 0) return;
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(triangles_.size() * 45);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(3 * unknowns);
    std::vector<double> trace(static_cast<std::size_t>(unknowns), 0);
    double all = 0;
    for (std::size_t i = 0; i < triangles_.size(); ++i)
      for (int j = 0; j < 3; ++j) {
        const int row = unknown[triangles_[i][j]];
        if (row < 0) continue;
        b.segment<3>(3 * row) += right[i].segment<3>(3 * j);
        const double part = matrices[i].block<3, 3>(3 * j, 3 * j).trace();
        trace[row] += part;
        all += part;
        for (int k = 0; k < 3; ++k) {
          const int column = unknown[triangles_[i][k]];
          if (column < 0 || column > row) continue;
          for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 3; ++x)
              if (column < row || x <= y)
                entries.emplace_back(3 * row + y, 3 * column + x, matrices[i](3 * j + y, 3 * k + x));
        }
      }
    for (int i = 0; i < unknowns; ++i)
      for (int x = 0; x < 3; ++x)
        entries.emplace_back(3 * i + x, 3 * i + x, damping * (trace[i] + 0.1 * all / unknowns) / 3);
    Eigen::SparseMatrix<double> matrix(3 * unknowns, 3 * unknowns);
    matrix.setFromTriplets(entries.begin(), entries.end());
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
    if (solver.info() != Eigen::Success) return;
    const Eigen::VectorXd steps = solver.solve(b);
    // Shorten the steps where weights go with a power of the distance: vertices would swing to and fro.
    std::vector<Vector> step(positions_.size(), Vector::Zero());
    for (std::size_t i = 0; i < positions_.size(); ++i)
      if (unknown[i] >= 0) step[i] = steps.segment<3>(3 * unknown[i]) / (1 + exponent);
    take(step);
  }

  /// Moves the vertices by `step` as far as the triangles allow: where one does not, its corners go half as far, at
  /// last not at all.
  void take(std::vector<Vector>& step) {
    std::vector<TriangleShape> before;
    for (const Triangle& t : triangles_) before.push_back(shape_of(t));
    const std::vector<Vector> start = positions_;
    for (int attempt = 0; attempt < 8; ++attempt) {
      for (std::size_t i = 0; i < positions_.size(); ++i) positions_[i] = start[i] + step[i];
      std::vector<std::uint8_t> is_bad(triangles_.size());
      parallel_for(std::size_t{0}, triangles_.size(),
                   [&](std::size_t i) { is_bad[i] = !may_become(before[i], triangles_[i]); });
      std::vector<bool> shorter(positions_.size(), false);
      bool any = false;
      for (std::size_t i = 0; i < triangles_.size(); ++i)
        if (is_bad[i]) {
          any = true;
          for (std::uint32_t vertex : triangles_[i]) shorter[vertex] = true;
        }
      if (!any) return;
      for (std::size_t i = 0; i < step.size(); ++i)
        if (shorter[i]) step[i] *= attempt < 3 ? 0.5 : 0.0;
    }
    positions_ = start;
  }

  bool may_become(const TriangleShape& before, const Triangle& t) const {
    const TriangleShape after = shape_of(t);
    const ShapeLimits limits{smallest_slenderness, thinnest_[t[0]]};
    if (!keeps_shape(before, after, limits, [&] { return before.normal; })) return false;
    return is_thin(after, limits) || faces_outwards(t, after);
  }
  bool faces_outwards(const Triangle& t, const TriangleShape& shape) const {
    const Vector middle = (positions_[t[0]] + positions_[t[1]] + positions_[t[2]]) / 3;
    const NearestSurface::Hit hit = surface_.nearest(middle, low_hints_.empty() ? 0 : low_hints_[0]);
    if (surface_.normal(hit).dot(shape.normal) >= smallest_facing * shape.normal.norm()) return true;
    const double within = std::sqrt(hit.squared_distance) + reach_;
    return surface_.nearest_facing(middle, {shape.normal, smallest_facing, within}, hit.hint).has_value();
  }

  void flip_edges(double exponent) {
    // List samples of the high mesh by the triangle that they are next to.
    std::vector<std::vector<std::uint32_t>> samples(triangles_.size());
    for (std::uint32_t i = 0; i < from_high_.size(); ++i) samples[from_high_[i].low.triangle].push_back(i);
    std::unordered_map<std::uint64_t, std::uint32_t> side;  // directed edge to its triangle
    const auto key = [](std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; };
    for (std::uint32_t i = 0; i < triangles_.size(); ++i)
      for (int k = 0; k < 3; ++k) side[key(triangles_[i][k], triangles_[i][(k + 1) % 3])] = i;
    const double rms = error().rms;
    int flips = 0;
    for (std::uint32_t i = 0; i < triangles_.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t a = triangles_[i][k], b = triangles_[i][(k + 1) % 3], c = triangles_[i][(k + 2) % 3];
        if (a > b || (is_fixed_[a] && is_fixed_[b])) continue;
        const auto other = side.find(key(b, a));
        if (other == side.end()) continue;
        const std::uint32_t j = other->second;
        const std::uint32_t d = triangles_[j][0] + triangles_[j][1] + triangles_[j][2] - a - b;
        if (c == d || side.contains(key(c, d)) || side.contains(key(d, c))) continue;
        // Flip: a, b, c and b, a, d become a, d, c and d, b, c.
        const Triangle first = {a, d, c}, second = {d, b, c};
        if (!is_better(i, j, first, second, samples, rms, exponent)) continue;
        triangles_[i] = first;
        triangles_[j] = second;
        side.erase(key(a, b));
        side.erase(key(b, a));
        side[key(a, d)] = side[key(d, c)] = side[key(c, a)] = i;
        side[key(d, b)] = side[key(b, c)] = side[key(c, d)] = j;
        std::vector<std::uint32_t> both = std::move(samples[i]);
        both.insert(both.end(), samples[j].begin(), samples[j].end());
        samples[i].clear();
        samples[j].clear();
        for (std::uint32_t sample : both) {
          const auto [d1, p1] = nearest_on(first, samples_[sample]);
          const auto [d2, p2] = nearest_on(second, samples_[sample]);
          const std::uint32_t now = d1 <= d2 ? i : j;
          samples[now].push_back(sample);
          from_high_[sample].distance = std::sqrt(std::min(d1, d2));
        }
        ++flips;
        break;
      }
    if (flips > 0) pair_up();
  }

  bool is_better(std::uint32_t i, std::uint32_t j, const Triangle& first, const Triangle& second,
                 const std::vector<std::vector<std::uint32_t>>& samples, double rms, double exponent) const {
    const TriangleShape before[2] = {shape_of(triangles_[i]), shape_of(triangles_[j])};
    const TriangleShape after[2] = {shape_of(first), shape_of(second)};
    const Vector normal = before[0].normal + before[1].normal;
    const double worst = std::min(before[0].squared_slenderness(), before[1].squared_slenderness());
    for (const TriangleShape& shape : after) {
      if (shape.normal.dot(normal) < 0.5 * shape.normal.norm() * normal.norm()) return false;
      if (shape.squared_slenderness() < std::min(worst, 0.1 * 0.1)) return false;
      if (shape.squared_height < 4 * std::pow(thinnest_[first[0]], 2)) return false;
    }
    double error_before = 0, error_after = 0;
    for (const std::uint32_t triangle : {i, j})
      for (std::uint32_t sample : samples[triangle]) {
        const double distance = from_high_[sample].distance;
        const double now =
            std::sqrt(std::min(nearest_on(first, samples_[sample]).first, nearest_on(second, samples_[sample]).first));
        error_before += distance * distance * weight_of(distance, rms, exponent);
        error_after += now * now * weight_of(now, rms, exponent);
      }
    if (!(error_after < 0.95 * error_before)) return false;
    return faces_outwards(first, after[0]) && faces_outwards(second, after[1]);
  }

  /// Returns the squared distance of p from a triangle, and the triangle's point that is nearest.
  std::pair<double, Vector> nearest_on(const Triangle& t, const Vector& p) const {
    const Vector &a = positions_[t[0]], &b = positions_[t[1]], &c = positions_[t[2]];
    const Vector weights = barycentric(p, a, b, c);
    if (weights.minCoeff() >= 0) {
      const Vector point = weights[0] * a + weights[1] * b + weights[2] * c;
      return {(p - point).squaredNorm(), point};
    }
    std::pair<double, Vector> best{HUGE_VAL, a};
    for (const auto& [from, to] : {std::pair(&a, &b), std::pair(&b, &c), std::pair(&c, &a)}) {
      const Vector along = *to - *from;
      const double at = std::clamp((p - *from).dot(along) / along.squaredNorm(), 0.0, 1.0);
      const Vector point = *from + at * along;
      if ((p - point).squaredNorm() < best.first) best = {(p - point).squaredNorm(), point};
    }
    return best;
  }

  static constexpr double smallest_slenderness = 0.02;
  static constexpr double smallest_facing = 0.1;  ///< cosine between the normals of a triangle and of the input there
  static constexpr double damping = 0.02;         ///< share of its own that is added to the diagonal of the equations

  const FitSettings& settings_;
  int sample_count_;
  UnitFrame frame_;
  TriangleMesh high_;  ///< in the frame, as are all positions below
  NearestSurface surface_;
  std::span<const std::uint8_t> is_fixed_;
  std::vector<Vector> positions_;
  std::vector<Triangle> triangles_;
  std::vector<float> thinnest_;  ///< by vertex of the low mesh (thinnest_heights)
  double reach_ = 0;             ///< by which a surface that faces rightly may be farther than the nearest
  std::vector<Vector> samples_, sample_normals_;
  std::vector<std::uint32_t> sample_hints_, low_hints_;
  std::vector<Pair> from_high_, from_low_;
  std::vector<TrianglePoint> low_samples_;
};

}  // namespace

TriangleMesh fit_to_surface(const TriangleMesh& low, const TriangleMesh& high, std::span<const std::uint8_t> is_fixed,
                            const FitSettings& settings, const ProgressFunction& progress) {
  return Fit(low, high, is_fixed, settings).run(low, progress);
}

}  // namespace kiln
