// SPDX-License-Identifier: MIT
#include "maps/seam_solver.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "maps/seam_equations.h"

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

}  // namespace

struct SeamSolver::System {
  int width = 0, height = 0;
  int block = 1;                        ///< unknowns per texel
  std::vector<std::uint32_t> unknowns;  ///< texels whose values are found
  std::vector<std::uint32_t> pinned;    ///< texels that equations see but must not change
  std::vector<double> keep;             ///< weight of keeping its value, per unknown
  std::vector<SeamPoint> points;        ///< points of the first equations
  std::vector<double> factors;          ///< factors of the points' weights
  std::vector<SeamEquation> equations;
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

}  // namespace

void SeamSolver::System::number_places(std::span<const std::uint32_t> number) {
  for (const SeamEquation& equation : equations)
    for (const SeamEquation::Term& term : equation.terms)
      if (number[term.texel] == SeamUnknowns::none) pinned.push_back(term.texel);
  std::sort(pinned.begin(), pinned.end());
  pinned.erase(std::unique(pinned.begin(), pinned.end()), pinned.end());
  for (SeamEquation& equation : equations)
    for (SeamEquation::Term& term : equation.terms)
      term.place =
          number[term.texel] != SeamUnknowns::none
              ? static_cast<int>(number[term.texel])
              : -1 - static_cast<int>(std::lower_bound(pinned.begin(), pinned.end(), term.texel) - pinned.begin());
}

template <class Visit>
void SeamSolver::System::for_each_product(const Visit& visit) const {
  for (std::size_t k = 0; k < equations.size(); ++k)
    for (const SeamEquation::Term& row : equations[k].terms) {
      if (row.place < 0) continue;
      for (const SeamEquation::Term& column : equations[k].terms)
        if (column.place <= row.place) visit(k, row, column);
    }
}

void SeamSolver::System::lay_out() {
  Triplets own, foreign;
  for (int k = 0; k < block * static_cast<int>(unknowns.size()); ++k) own.emplace_back(k, k, 0);
  for_each_product([&](std::size_t, const SeamEquation::Term& row, const SeamEquation::Term& column) {
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
  for_each_product([&](std::size_t k, const SeamEquation::Term& row, const SeamEquation::Term& column) {
    const double weight = equations[k].weight * (k < factors.size() ? factors[k] : 1.0) * row.weight * column.weight;
    if (block == 1) {
      (column.place < 0 ? from_pinned.valuePtr()[*foreign_place++] : normal.valuePtr()[*own_place++]) += weight;
      return;
    }
    const Eigen::Matrix3d product = equations[k].frames[static_cast<std::size_t>(row.side)].transpose() *
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
  own.equations = point_equations(seams, own.points, space);
  SeamUnknowns unknowns(own.equations, covered.size());
  for (SeamEquation& equation : gutter_equations(seams, covered, unknowns, space, weights.across))
    own.equations.push_back(std::move(equation));
  own.unknowns = std::move(unknowns.texels);
  for (const std::uint32_t texel : own.unknowns)
    own.keep.push_back(covered[texel] != 0 ? weights.covered : weights.gutter);
  own.number_places(unknowns.number);
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
