// SPDX-License-Identifier: GPL-3.0-or-later
// [Davis 2005]: the factorisation L D L^T, row by row along the elimination tree; here of 2 x 2 blocks. The order is
// approximately that of minimum degree.
#include "atlas/block_cholesky.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>

#include "atlas/surface.h"

namespace kiln {

BlockCholesky::BlockCholesky(std::size_t vertices, const std::vector<Edge>& edges) {
  order(vertices, edges);
  offsets_.assign(vertices + 1, 0);
  for (const auto& [a, b] : edges) ++offsets_[std::max(place_[a], place_[b]) + 1];
  for (std::size_t k = 0; k < vertices; ++k) offsets_[k + 1] += offsets_[k];
  upper_.resize(edges.size());
  std::vector<std::uint32_t> filled(offsets_.begin(), offsets_.end() - 1);
  for (std::uint32_t e = 0; e < edges.size(); ++e) {
    const auto [row, column] = std::minmax(place_[edges[e].first], place_[edges[e].second]);
    upper_[filled[column]++] = {row, e};
  }
  find_factor_pattern();
}

void BlockCholesky::order(std::size_t vertices, const std::vector<Edge>& edges) {
  using Pattern = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
  Pattern pattern(static_cast<Eigen::Index>(vertices), static_cast<Eigen::Index>(vertices));
  // Store both triangles, column by column; readers do not depend on the order of a column's rows.
  std::vector<int> starts(vertices + 1, 0);
  for (const auto& [a, b] : edges) ++starts[a + 1], ++starts[b + 1];
  for (std::size_t v = 0; v < vertices; ++v) starts[v + 1] += starts[v] + 1;
  pattern.resizeNonZeros(starts.back());
  std::copy(starts.begin(), starts.end(), pattern.outerIndexPtr());
  std::fill_n(pattern.valuePtr(), starts.back(), 1.0);
  const auto add = [&](std::uint32_t column, std::uint32_t row) {
    pattern.innerIndexPtr()[starts[column]++] = static_cast<int>(row);
  };
  for (std::uint32_t v = 0; v < vertices; ++v) add(v, v);
  for (const auto& [a, b] : edges) add(a, b), add(b, a);

  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> elimination;
  Eigen::internal::minimum_degree_ordering(pattern, elimination);
  vertex_.resize(vertices);
  place_.resize(vertices);
  for (std::uint32_t k = 0; k < vertices; ++k) {
    vertex_[k] = static_cast<std::uint32_t>(elimination.indices()[k]);
    place_[vertex_[k]] = k;
  }
}

void BlockCholesky::find_factor_pattern() {
  const std::size_t count = vertex_.size();
  parent_.assign(count, no_index);
  std::vector<std::uint32_t> seen(count, no_index), lengths(count, 0);
  for (std::uint32_t k = 0; k < count; ++k) {
    seen[k] = k;
    for (std::uint32_t e = offsets_[k]; e < offsets_[k + 1]; ++e)
      for (std::uint32_t i = upper_[e].row; seen[i] != k; i = parent_[i]) {
        if (parent_[i] == no_index) parent_[i] = k;
        ++lengths[i];
        seen[i] = k;
      }
  }
  factor_offsets_.assign(count + 1, 0);
  for (std::size_t k = 0; k < count; ++k) factor_offsets_[k + 1] = factor_offsets_[k] + lengths[k];
  factor_rows_.resize(factor_offsets_.back());
  factor_.resize(factor_offsets_.back());
  inverse_diagonal_.resize(count);
}

bool BlockCholesky::factorise(const std::vector<SymmetricBlock>& diagonal,
                              const std::vector<SymmetricBlock>& off_diagonal) {
  const std::size_t count = vertex_.size();
  std::vector<Block> row(count, Block{});
  std::vector<std::uint32_t> seen(count, no_index), path(count), pattern(count);
  std::vector<std::uint32_t> ends(factor_offsets_.begin(), factor_offsets_.end() - 1);
  for (std::uint32_t k = 0; k < count; ++k) {
    // Step 1: scatter column k above the diagonal, and find which columns of the factor it meets, children before
    // parents.
    std::size_t top = count;
    seen[k] = k;
    for (std::uint32_t e = offsets_[k]; e < offsets_[k + 1]; ++e) {
      const SymmetricBlock& value = off_diagonal[upper_[e].edge];
      row[upper_[e].row] = {value.xx, value.xy, value.xy, value.yy};
      std::size_t length = 0;
      for (std::uint32_t i = upper_[e].row; seen[i] != k; i = parent_[i]) {
        path[length++] = i;
        seen[i] = k;
      }
      while (length > 0) pattern[--top] = path[--length];
    }
    // Step 2: compute row k of the factor, and its diagonal.
    SymmetricBlock d = diagonal[vertex_[k]];
    for (; top < count; ++top) {
      const std::uint32_t i = pattern[top];
      const Block x = row[i];
      row[i] = {};
      for (std::uint32_t p = factor_offsets_[i]; p < ends[i]; ++p) {
        const Block& l = factor_[p];
        Block& target = row[factor_rows_[p]];
        target[0] -= l[0] * x[0] + l[1] * x[2];
        target[1] -= l[0] * x[1] + l[1] * x[3];
        target[2] -= l[2] * x[0] + l[3] * x[2];
        target[3] -= l[2] * x[1] + l[3] * x[3];
      }
      const SymmetricBlock& inverse = inverse_diagonal_[i];
      // The row's block is x^T D^-1.
      const Block l = {x[0] * inverse.xx + x[2] * inverse.xy, x[0] * inverse.xy + x[2] * inverse.yy,
                       x[1] * inverse.xx + x[3] * inverse.xy, x[1] * inverse.xy + x[3] * inverse.yy};
      d.xx -= l[0] * x[0] + l[1] * x[2];
      d.xy -= l[0] * x[1] + l[1] * x[3];
      d.yy -= l[2] * x[1] + l[3] * x[3];
      factor_rows_[ends[i]] = k;
      factor_[ends[i]++] = l;
    }
    const double determinant = d.xx * d.yy - d.xy * d.xy;
    if (!(d.xx > 0) || !(determinant > 0)) return false;
    inverse_diagonal_[k] = {d.yy / determinant, -d.xy / determinant, d.xx / determinant};
  }
  return true;
}

std::vector<Eigen::Vector2d> BlockCholesky::solve(const std::vector<Eigen::Vector2d>& right_side) const {
  const std::size_t count = vertex_.size();
  std::vector<Eigen::Vector2d> x(count), result(count);
  for (std::size_t k = 0; k < count; ++k) x[k] = right_side[vertex_[k]];
  for (std::size_t k = 0; k < count; ++k) {
    const Eigen::Vector2d v = x[k];
    for (std::uint32_t p = factor_offsets_[k]; p < factor_offsets_[k + 1]; ++p) {
      const Block& l = factor_[p];
      x[factor_rows_[p]] -= Eigen::Vector2d(l[0] * v.x() + l[1] * v.y(), l[2] * v.x() + l[3] * v.y());
    }
  }
  for (std::size_t k = count; k-- > 0;) {
    const SymmetricBlock& d = inverse_diagonal_[k];
    Eigen::Vector2d v(d.xx * x[k].x() + d.xy * x[k].y(), d.xy * x[k].x() + d.yy * x[k].y());
    for (std::uint32_t p = factor_offsets_[k]; p < factor_offsets_[k + 1]; ++p) {
      const Block& l = factor_[p];
      const Eigen::Vector2d& w = x[factor_rows_[p]];
      v -= Eigen::Vector2d(l[0] * w.x() + l[2] * w.y(), l[1] * w.x() + l[3] * w.y());
    }
    x[k] = v;
    result[vertex_[k]] = v;
  }
  return result;
}

}  // namespace kiln
