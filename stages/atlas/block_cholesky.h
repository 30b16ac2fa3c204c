// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace kiln {

/// Symmetric 2 x 2 matrix.
struct SymmetricBlock {
  double xx = 0, xy = 0, yy = 0;

  void add(double factor, const SymmetricBlock& other) {
    xx += factor * other.xx;
    xy += factor * other.xy;
    yy += factor * other.yy;
  }
};

/// Solves sparse symmetric positive definite systems of 2 x 2 blocks: one per vertex on the diagonal, and one, itself
/// symmetric, per edge. Least squares over the vertices of a planar map give such systems. The pattern is analysed once
/// and factorised for any number of values. Faster than a general sparse solver, which sees four entries in every
/// block.
class BlockCholesky {
 public:
  using Edge = std::pair<std::uint32_t, std::uint32_t>;  ///< two different vertices; each edge once

  BlockCholesky(std::size_t vertices, const std::vector<Edge>& edges);

  /// Factorises; `diagonal` per vertex, `off_diagonal` per edge. False where the matrix is not positive definite.
  bool factorise(const std::vector<SymmetricBlock>& diagonal, const std::vector<SymmetricBlock>& off_diagonal);

  /// Solves for two unknowns per vertex, after `factorise` returned true.
  std::vector<Eigen::Vector2d> solve(const std::vector<Eigen::Vector2d>& right_side) const;

 private:
  using Block = std::array<double, 4>;  ///< row by row
  struct UpperEntry {
    std::uint32_t row, edge;
  };

  void order(std::size_t vertices, const std::vector<Edge>& edges);
  void find_factor_pattern();

  std::vector<std::uint32_t> place_;    ///< place of each vertex in the order of elimination
  std::vector<std::uint32_t> vertex_;   ///< the inverse of place_
  std::vector<std::uint32_t> offsets_;  ///< per column: start of its entries above the diagonal
  std::vector<UpperEntry> upper_;
  std::vector<std::uint32_t> parent_;          ///< parent in the elimination tree, or no_index
  std::vector<std::uint32_t> factor_offsets_;  ///< per column of the factor
  std::vector<std::uint32_t> factor_rows_;
  std::vector<Block> factor_;
  std::vector<SymmetricBlock> inverse_diagonal_;
};

}  // namespace kiln
