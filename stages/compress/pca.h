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
  Eigen::MatrixXf vectors;       ///< columns, orthonormal, those of most variance first
  Eigen::VectorXd variances;     ///< summed over texels
  std::vector<double> residual;  ///< [n]: the squared length that the first n leave, summed over texels

  /// The model of the first `components`.
  PcaModel model(int components) const;
};

PrincipalComponents principal_components(const TransferSource& source);

/// Mean and principal components of the columns of `vectors`, at least one. Fewer columns than `components` are
/// completed to an orthonormal basis.
void fit_subspace(const Eigen::MatrixXf& vectors, int components, Eigen::VectorXf& mean, Eigen::MatrixXf& basis);

}  // namespace kiln
