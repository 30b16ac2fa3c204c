// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "compress/transfer_source.h"

namespace kiln {

/// Affine subspaces, one per cluster, in the weighted space of TransferSource: x = mean + basis * weights.
struct PcaModel {
  int components = 0;
  std::vector<Eigen::VectorXf> means;
  std::vector<Eigen::MatrixXf> bases;  ///< length x components each

  int clusters() const { return static_cast<int>(means.size()); }
};

/// Principal components of all covered texels.
struct PrincipalComponents {
  Eigen::VectorXf mean;
  Eigen::MatrixXf vectors;       ///< columns, orthonormal, largest variance first
  Eigen::VectorXd variances;     ///< summed over texels
  std::vector<double> residual;  ///< [n]: squared distance to the subspace of the first n, summed over texels

  /// Returns the model of the first `components`.
  PcaModel model(int components) const;
};

PrincipalComponents principal_components(const TransferSource& source);

/// Computes the mean and principal components of the columns of `vectors`, of which there is at least one. If there are
/// fewer columns than `components`, the basis is completed to an orthonormal one.
void fit_subspace(const Eigen::MatrixXf& vectors, int components, Eigen::VectorXf& mean, Eigen::MatrixXf& basis);

}  // namespace kiln
