// SPDX-License-Identifier: GPL-3.0-or-later
#include "compress/pca.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <utility>

#include "compress/chunks.h"

namespace kiln {

namespace {

/// Gives each vector a positive largest entry, so that the result does not depend on a solver's choice of sign.
void choose_signs(Eigen::MatrixXf& vectors) {
  for (Eigen::Index k = 0; k < vectors.cols(); ++k) {
    Eigen::Index largest = 0;
    vectors.col(k).cwiseAbs().maxCoeff(&largest);
    if (vectors(largest, k) < 0) vectors.col(k) *= -1;
  }
}

/// Computes eigenvectors by falling eigenvalue.
void sorted_eigenvectors(const Eigen::MatrixXd& covariance, Eigen::MatrixXf& vectors, Eigen::VectorXd& values) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  values = solver.eigenvalues().reverse().cwiseMax(0);
  vectors = solver.eigenvectors().rowwise().reverse().cast<float>();
  choose_signs(vectors);
}

/// Computes the first `count` eigenvectors of the covariance of columns about zero, of which there are fewer than rows:
/// from products of the columns, at a cost that grows with the square of their number, not with the cube of the rows.
/// The QR decomposition makes them orthonormal, and adds others where the columns span less.
Eigen::MatrixXf few_columns_eigenvectors(const Eigen::MatrixXd& columns, int count) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(columns.transpose() * columns);
  const Eigen::MatrixXd scaled =
      columns * solver.eigenvectors().rowwise().reverse().leftCols(std::min<Eigen::Index>(count, columns.cols()));
  Eigen::MatrixXf vectors =
      (Eigen::HouseholderQR<Eigen::MatrixXd>(scaled).householderQ() * Eigen::MatrixXd::Identity(columns.rows(), count))
          .cast<float>();
  choose_signs(vectors);
  return vectors;
}

}  // namespace

PcaModel PrincipalComponents::model(int components) const {
  return {components, {mean}, {vectors.leftCols(components)}};
}

PrincipalComponents principal_components(const TransferSource& source) {
  const std::vector<std::uint32_t>& texels = source.covered();
  const std::size_t chunks = (texels.size() + chunk_texels - 1) / chunk_texels;
  const auto size = static_cast<double>(texels.size());

  // Compute the mean, then the covariance about it, with sums in float64, chunk after chunk.
  std::vector<Eigen::VectorXd> sums(chunks);
  for_each_chunk(texels.size(), [&](std::size_t first, std::size_t count) {
    sums[first / chunk_texels] = source.vectors(std::span(texels).subspan(first, count)).cast<double>().rowwise().sum();
  });
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(source.length());
  for (const Eigen::VectorXd& sum : sums) mean += sum / size;
  constexpr std::size_t group = 64;  // chunks whose covariances are in memory at once
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(source.length(), source.length());
  for (std::size_t begin = 0; begin < texels.size(); begin += group * chunk_texels) {
    std::vector<Eigen::MatrixXd> parts(group);
    for_each_chunk(std::min(group * chunk_texels, texels.size() - begin), [&](std::size_t first, std::size_t count) {
      const Eigen::MatrixXd centred =
          source.vectors(std::span(texels).subspan(begin + first, count)).cast<double>().colwise() - mean;
      parts[first / chunk_texels] = centred * centred.transpose();
    });
    for (const Eigen::MatrixXd& part : parts)
      if (part.size() > 0) covariance += part;
  }

  PrincipalComponents result;
  result.mean = mean.cast<float>();
  sorted_eigenvectors(covariance, result.vectors, result.variances);
  result.residual.assign(static_cast<std::size_t>(source.length()) + 1, 0.0);
  for (int n = source.length() - 1; n >= 0; --n)
    result.residual[static_cast<std::size_t>(n)] =
        result.residual[static_cast<std::size_t>(n) + 1] + result.variances[n];
  return result;
}

void fit_subspace(const Eigen::MatrixXf& vectors, int components, Eigen::VectorXf& mean, Eigen::MatrixXf& basis) {
  const Eigen::MatrixXd exact = vectors.cast<double>();
  const Eigen::VectorXd centre = exact.rowwise().mean();
  const Eigen::MatrixXd centred = exact.colwise() - centre;
  mean = centre.cast<float>();
  if (centred.cols() < centred.rows()) {
    basis = few_columns_eigenvectors(centred, components);
    return;
  }
  Eigen::MatrixXf all;
  Eigen::VectorXd values;
  sorted_eigenvectors(centred * centred.transpose(), all, values);
  basis = all.leftCols(components);
}

}  // namespace kiln
