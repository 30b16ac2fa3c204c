// SPDX-License-Identifier: MIT
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "detail/seams.h"
#include "mesh/tangent_space.h"

namespace kiln {

namespace {

/// Sampling density along seams. Below 2, a lookup between two samples could see a texel that no sample sees; with 2,
/// such lookups still differ up to twice as much as with 3; with 4 nothing more changes.
constexpr double samples_per_texel = 3;

/// Threshold for reweighting: points with more than this multiple of the mean mismatch get more weight.
constexpr double times_usual = 3;

/// Upper bound of the factors, which keeps the normal equations well conditioned.
constexpr double largest_factor = 1e4;

using Sparse = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Rotation applied to the values of a seam's side before they are compared.
using Frame = Eigen::Matrix3d;

/// Equation: the sum over both sides of frame * weight * value is 0.
struct Equation {
  struct Term {
    std::uint32_t texel;
    double weight;
    int side;
    int place = 0;  ///< among the unknown texels, or -1 - k for the k-th pinned one
  };
  std::vector<Term> terms;
  std::array<Frame, 2> frames;
  double weight = 0;
};

/// Place of a gutter texel across its nearest seam.
struct Across {
  float distance_texels = std::numeric_limits<float>::infinity();
  std::uint32_t edge = 0;
  int side = 0;
};

constexpr std::uint32_t none = ~0u;

/// Edge of a seam in one chart, in texels.
struct Segment {
  Eigen::Vector2f from, along;
  Eigen::Vector2f outwards;  ///< perpendicular to `along`, as long, away from its triangle

  Segment(const Seams& seams, const Seams::Edge& edge, int side) {
    const TriangleMesh& mesh = seams.atlas();
    const Eigen::Vector2f size(static_cast<float>(seams.width()), static_cast<float>(seams.height()));
    const auto corner = [&](int k) -> Eigen::Vector2f {
      return mesh.uvs[mesh.triangles[edge.triangles[static_cast<std::size_t>(side)]][static_cast<std::size_t>(k)]]
          .cwiseProduct(size);
    };
    const auto& corners = edge.corners[static_cast<std::size_t>(side)];
    from = corner(corners[0]);
    along = corner(corners[1]) - from;
    outwards = {-along.y(), along.x()};
    if (outwards.dot(corner(3 - corners[0] - corners[1]) - from) > 0) outwards = -outwards;
  }

  /// Returns coordinates of a point (texels) relative to the edge, in lengths of the edge: along it (0 to 1) and
  /// outwards.
  Eigen::Vector2f coordinates(const Eigen::Vector2f& point) const {
    const float squared = along.squaredNorm();
    if (!(squared > 0)) return {0, std::numeric_limits<float>::infinity()};
    return Eigen::Vector2f(along.dot(point - from), outwards.dot(point - from)) / squared;
  }

  float distance(const Eigen::Vector2f& point) const {
    const float squared = along.squaredNorm();
    const float s = squared > 0 ? std::clamp(along.dot(point - from) / squared, 0.0f, 1.0f) : 0.0f;
    return (from + s * along - point).norm();
  }
};

}  // namespace

struct SeamSolver::System {
  int width = 0, height = 0;
  int block = 1;                        ///< unknowns per texel
  std::vector<std::uint32_t> unknowns;  ///< texels
  std::vector<std::uint32_t> pinned;    ///< texels that equations see but must not change
  std::vector<double> keep;             ///< weight of keeping its value, per unknown
  std::vector<SeamPoint> points;        ///< points of the first equations
  std::vector<double> factors;          ///< factors of the points' weights
  std::vector<Equation> equations;
  Sparse normal;                        ///< the normal equations, lower half
  Sparse symmetric;                     ///< both halves
  Sparse from_pinned;                   ///< rows: unknowns, columns: pinned
  std::vector<int> own_at, foreign_at;  ///< places of products in those two, in for_each_product's order
  Eigen::SimplicialLDLT<Sparse> factor;

  void number_places(std::span<const std::uint32_t> number);
  void lay_out();
  void factorise();
  /// Calls visit(index of the equation, row's term, column's term).
  template <class Visit>
  void for_each_product(const Visit& visit) const;
};

namespace {

/// Makes the equations of equality at points along the seams.
std::vector<Equation> seam_equations(const Seams& seams, std::span<const SeamPoint> points, NormalSpace space) {
  const TriangleMesh& mesh = seams.atlas();
  const std::vector<TangentFrame> frames =
      space == NormalSpace::tangent ? tangent_frames(mesh) : std::vector<TangentFrame>{};
  std::vector<Equation> equations;
  for (const SeamPoint& point : points) {
    Equation equation;
    equation.weight = static_cast<double>(point.length_texels);
    for (int side = 0; side < 2; ++side) {
      const SeamSide& at = point.sides[static_cast<std::size_t>(side)];
      Frame& frame = equation.frames[static_cast<std::size_t>(side)];
      frame.setIdentity();
      if (space == NormalSpace::tangent)
        for (int axis = 0; axis < 3; ++axis)
          frame.col(axis) = to_object_space(Eigen::Vector3f::Unit(axis), interpolate(mesh, mesh.normals, at.source),
                                            interpolate(mesh, frames, at.source))
                                .cast<double>();
      for (std::size_t k = 0; k < 4; ++k)
        if (at.footprint.weights[k] > 0)
          equation.terms.push_back(
              {at.footprint.texels[k], (side == 0 ? 1.0 : -1.0) * static_cast<double>(at.footprint.weights[k]), side});
    }
    equations.push_back(std::move(equation));
  }
  return equations;
}

/// Solves the bounded least squares of `normal` x = `right` with every x in `lowest` to `highest`, starting from the
/// free solution: each unknown in turn gets its best value within the bounds, given the others.
void keep_within(const Sparse& normal, const Eigen::VectorXd& right, double lowest, double highest,
                 Eigen::VectorXd& values) {
  constexpr int most_sweeps = 50;
  const double small_change = 1e-5 * (highest - lowest);  // far less than a step of 8 bits
  values = values.cwiseMax(lowest).cwiseMin(highest);
  double change = std::numeric_limits<double>::infinity();
  for (int sweep = 0; sweep < most_sweeps && change > small_change; ++sweep) {
    change = 0;
    for (Eigen::Index k = 0; k < values.size(); ++k) {
      double residual = right[k], diagonal = 0;
      for (Sparse::InnerIterator entry(normal, k); entry; ++entry) {
        residual -= entry.value() * values[entry.index()];
        if (entry.index() == k) diagonal = entry.value();
      }
      const double value = std::clamp(values[k] + residual / diagonal, lowest, highest);
      change = std::max(change, std::abs(value - values[k]));
      values[k] = value;
    }
  }
}

/// Finds the nearest seam of every texel among the `number`ed ones that is not covered.
std::vector<Across> nearest_seams(const Seams& seams, std::span<const std::uint8_t> covered,
                                  std::span<const std::uint32_t> number, std::size_t count) {
  std::vector<Across> nearest(count);
  for (std::uint32_t e = 0; e < seams.edges().size(); ++e)
    for (int side = 0; side < 2; ++side) {
      const Segment segment(seams, seams.edges()[e], side);
      // Walk over the texels about the edge along its longer direction.
      const int steps = std::max(1, static_cast<int>(std::ceil(segment.along.norm())));
      for (int k = 0; k <= steps; ++k) {
        const Eigen::Vector2f at = segment.from + static_cast<float>(k) / static_cast<float>(steps) * segment.along;
        const int column = static_cast<int>(std::floor(at.x())), row = static_cast<int>(std::floor(at.y()));
        for (int j = std::max(0, row - 2); j <= std::min(seams.height() - 1, row + 2); ++j)
          for (int i = std::max(0, column - 2); i <= std::min(seams.width() - 1, column + 2); ++i) {
            const std::size_t texel =
                static_cast<std::size_t>(j) * static_cast<std::size_t>(seams.width()) + static_cast<std::size_t>(i);
            if (number[texel] == none || covered[texel] != 0) continue;
            const float distance = segment.distance({static_cast<float>(i) + 0.5f, static_cast<float>(j) + 0.5f});
            Across& best = nearest[number[texel]];
            if (distance < best.distance_texels) best = {distance, e, side};
          }
      }
    }
  return nearest;
}

}  // namespace

void SeamSolver::System::number_places(std::span<const std::uint32_t> number) {
  for (const Equation& equation : equations)
    for (const Equation::Term& term : equation.terms)
      if (number[term.texel] == none) pinned.push_back(term.texel);
  std::sort(pinned.begin(), pinned.end());
  pinned.erase(std::unique(pinned.begin(), pinned.end()), pinned.end());
  for (Equation& equation : equations)
    for (Equation::Term& term : equation.terms)
      term.place =
          number[term.texel] != none
              ? static_cast<int>(number[term.texel])
              : -1 - static_cast<int>(std::lower_bound(pinned.begin(), pinned.end(), term.texel) - pinned.begin());
}

template <class Visit>
void SeamSolver::System::for_each_product(const Visit& visit) const {
  for (std::size_t k = 0; k < equations.size(); ++k)
    for (const Equation::Term& row : equations[k].terms) {
      if (row.place < 0) continue;
      for (const Equation::Term& column : equations[k].terms)
        if (column.place <= row.place) visit(k, row, column);
    }
}

void SeamSolver::System::lay_out() {
  Triplets own, foreign;
  for (int k = 0; k < block * static_cast<int>(unknowns.size()); ++k) own.emplace_back(k, k, 0);
  for_each_product([&](std::size_t, const Equation::Term& row, const Equation::Term& column) {
    for (int r = 0; r < block; ++r)
      for (int c = 0; c < block; ++c) {
        const int i = block * row.place + r;
        if (column.place < 0)
          foreign.emplace_back(i, block * (-1 - column.place) + c, 0);
        else if (const int j = block * column.place + c; i >= j)
          own.emplace_back(i, j, 0);
      }
  });
  const auto size = static_cast<Eigen::Index>(block) * static_cast<Eigen::Index>(unknowns.size());
  normal.resize(size, size);
  normal.setFromTriplets(own.begin(), own.end());
  from_pinned.resize(size, static_cast<Eigen::Index>(block) * static_cast<Eigen::Index>(pinned.size()));
  from_pinned.setFromTriplets(foreign.begin(), foreign.end());

  // Record where each product goes, so that new weights need no search.
  const auto find = [](const Sparse& matrix, int i, int j) {
    const int* column = matrix.innerIndexPtr() + matrix.outerIndexPtr()[j];
    return static_cast<int>(std::lower_bound(column, matrix.innerIndexPtr() + matrix.outerIndexPtr()[j + 1], i) -
                            matrix.innerIndexPtr());
  };
  for (const Triplets* products : {&own, &foreign})
    for (const auto& product : *products)
      (products == &own ? own_at : foreign_at)
          .push_back(find(products == &own ? normal : from_pinned, product.row(), product.col()));
  factor.analyzePattern(normal);
}

void SeamSolver::System::factorise() {
  std::fill_n(normal.valuePtr(), normal.nonZeros(), 0.0);
  std::fill_n(from_pinned.valuePtr(), from_pinned.nonZeros(), 0.0);
  const int* own_place = own_at.data();
  const int* foreign_place = foreign_at.data();
  for (std::size_t k = 0; k < unknowns.size(); ++k)
    for (int c = 0; c < block; ++c) normal.valuePtr()[*own_place++] += keep[k];
  for_each_product([&](std::size_t k, const Equation::Term& row, const Equation::Term& column) {
    const double weight = equations[k].weight * (k < factors.size() ? factors[k] : 1.0) * row.weight * column.weight;
    if (block == 1) {
      (column.place < 0 ? from_pinned.valuePtr()[*foreign_place++] : normal.valuePtr()[*own_place++]) += weight;
      return;
    }
    const Frame product = equations[k].frames[static_cast<std::size_t>(row.side)].transpose() *
                          equations[k].frames[static_cast<std::size_t>(column.side)];
    for (int r = 0; r < block; ++r)
      for (int c = 0; c < block; ++c)
        if (column.place < 0)
          from_pinned.valuePtr()[*foreign_place++] += weight * product(r, c);
        else if (block * row.place + r >= block * column.place + c)
          normal.valuePtr()[*own_place++] += weight * product(r, c);
  });
  symmetric = normal.selfadjointView<Eigen::Lower>();
  factor.factorize(normal);
  if (factor.info() != Eigen::Success)
    throw std::runtime_error("SeamSolver: the normal equations cannot be factorised");
}

SeamSolver::SeamSolver(const Seams& seams, std::span<const std::uint8_t> covered, NormalSpace space,
                       const SeamWeights& weights)
    : system_(std::make_unique<System>()) {
  System& own = *system_;
  own.width = seams.width();
  own.height = seams.height();
  own.block = space == NormalSpace::tangent ? 3 : 1;
  if (covered.size() != static_cast<std::size_t>(own.width) * static_cast<std::size_t>(own.height))
    throw std::invalid_argument("SeamSolver: one coverage value per texel is needed");
  own.points = seams.points(samples_per_texel);
  std::vector<Equation>& equations = own.equations;
  equations = seam_equations(seams, own.points, space);

  // Unknowns are the texels that lookups on seams see.
  std::vector<std::uint32_t> number(covered.size(), none);
  for (const Equation& equation : equations)
    for (const Equation::Term& term : equation.terms) number[term.texel] = 0;
  for (std::uint32_t texel = 0; texel < number.size(); ++texel)
    if (number[texel] == 0) {
      number[texel] = static_cast<std::uint32_t>(own.unknowns.size());
      own.unknowns.push_back(texel);
    }

  // Gutter texels continue what lies across the seam.
  const std::vector<Across> nearest = nearest_seams(seams, covered, number, own.unknowns.size());
  const std::vector<TangentFrame> frames =
      space == NormalSpace::tangent ? tangent_frames(seams.atlas()) : std::vector<TangentFrame>{};
  for (std::size_t k = 0; k < own.unknowns.size(); ++k) {
    if (!std::isfinite(nearest[k].distance_texels)) continue;
    const Seams::Edge& edge = seams.edges()[nearest[k].edge];
    const int side = nearest[k].side, other = 1 - side;
    const Segment here(seams, edge, side), there(seams, edge, other);
    const auto column = static_cast<float>(own.unknowns[k] % static_cast<std::uint32_t>(own.width)),
               row = static_cast<float>(own.unknowns[k] / static_cast<std::uint32_t>(own.width));
    const Eigen::Vector2f place = here.coordinates({column + 0.5f, row + 0.5f});
    if (!place.allFinite()) continue;
    const Eigen::Vector2f at = there.from + place.x() * there.along - place.y() * there.outwards;
    const Footprint footprint(
        at.cwiseQuotient(Eigen::Vector2f(static_cast<float>(own.width), static_cast<float>(own.height))), own.width,
        own.height);
    Equation equation;
    equation.weight = weights.across;
    equation.terms.push_back({own.unknowns[k], 1, 0});
    for (std::size_t n = 0; n < 4; ++n)
      if (footprint.weights[n] > 0) equation.terms.push_back({footprint.texels[n], -footprint.weights[n], 1});
    // Take both frames at the edge: beyond it there are none.
    for (int s = 0; s < 2; ++s) {
      Frame& frame = equation.frames[static_cast<std::size_t>(s)];
      frame.setIdentity();
      if (space != NormalSpace::tangent) continue;
      const int which = s == 0 ? side : other;
      const Triangle& t = seams.atlas().triangles[edge.triangles[static_cast<std::size_t>(which)]];
      const auto& corners = edge.corners[static_cast<std::size_t>(which)];
      const float along = std::clamp(place.x(), 0.0f, 1.0f);
      const Eigen::Vector3f normal =
          (1 - along) * seams.atlas().normals[t[corners[0]]] + along * seams.atlas().normals[t[corners[1]]];
      const TangentFrame at_edge{(1 - along) * frames[t[corners[0]]].tangent + along * frames[t[corners[1]]].tangent,
                                 frames[t[corners[0]]].sign};
      for (int axis = 0; axis < 3; ++axis)
        frame.col(axis) = to_object_space(Eigen::Vector3f::Unit(axis), normal, at_edge).cast<double>();
    }
    equations.push_back(std::move(equation));
  }
  for (const std::uint32_t texel : own.unknowns)
    own.keep.push_back(covered[texel] != 0 ? weights.covered : weights.gutter);
  own.number_places(number);
  own.lay_out();
  own.factors.assign(own.points.size(), 1.0);
  own.factorise();
}

SeamSolver::~SeamSolver() = default;
SeamSolver::SeamSolver(SeamSolver&&) noexcept = default;
SeamSolver& SeamSolver::operator=(SeamSolver&&) noexcept = default;

std::size_t SeamSolver::unknown_texels() const { return system_->unknowns.size(); }

std::span<const SeamPoint> SeamSolver::points() const { return system_->points; }

void SeamSolver::reweigh(std::span<const double> mismatches) {
  System& own = *system_;
  if (mismatches.size() != own.points.size())
    throw std::invalid_argument("SeamSolver: one mismatch per point is needed");
  const double usual = times_usual * Seams::summarise(own.points, mismatches).mean;
  if (!(usual > 0)) return;
  for (std::size_t k = 0; k < mismatches.size(); ++k) {
    const double times = std::max(1.0, mismatches[k] / usual);
    own.factors[k] = std::min(largest_factor, own.factors[k] * times * times);
  }
  own.factorise();
}

void SeamSolver::equalise(Image<float>& image, float lowest, float highest) const {
  const System& own = *system_;
  if (image.width() != own.width || image.height() != own.height || image.channels() % own.block != 0)
    throw std::invalid_argument("SeamSolver: an image of the seams' size is needed");
  if (own.unknowns.empty()) return;
  const auto channels = static_cast<std::size_t>(image.channels());
  const auto block = static_cast<std::size_t>(own.block);
  for (std::size_t first = 0; first < channels; first += block) {
    const auto value = [&](std::uint32_t texel, std::size_t c) -> float& {
      return image.values()[static_cast<std::size_t>(texel) * channels + first + c];
    };
    const auto gather = [&](const std::vector<std::uint32_t>& texels) {
      Eigen::VectorXd values(static_cast<Eigen::Index>(block * texels.size()));
      for (std::size_t k = 0; k < texels.size(); ++k)
        for (std::size_t c = 0; c < block; ++c)
          values[static_cast<Eigen::Index>(block * k + c)] = static_cast<double>(value(texels[k], c));
      return values;
    };
    Eigen::VectorXd right = gather(own.unknowns);
    for (std::size_t k = 0; k < own.unknowns.size(); ++k)
      for (std::size_t c = 0; c < block; ++c) right[static_cast<Eigen::Index>(block * k + c)] *= own.keep[k];
    right -= own.from_pinned * gather(own.pinned);
    Eigen::VectorXd solved = own.factor.solve(right);
    if (solved.minCoeff() < lowest || solved.maxCoeff() > highest)
      keep_within(own.symmetric, right, static_cast<double>(lowest), static_cast<double>(highest), solved);
    for (std::size_t k = 0; k < own.unknowns.size(); ++k)
      for (std::size_t c = 0; c < block; ++c)
        value(own.unknowns[k], c) = static_cast<float>(solved[static_cast<Eigen::Index>(block * k + c)]);
  }
}

}  // namespace kiln
