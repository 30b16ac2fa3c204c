// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <span>
#include <vector>

#include "sh/basis.h"

namespace kiln {

/// Evaluates B_i(s_d) for all directions, row after row.
inline std::vector<float> sh_rows(std::span<const Eigen::Vector3f> directions, int bands) {
  const ShBasis basis(bands);
  std::vector<float> rows(directions.size() * basis.size());
  std::vector<double> values(basis.size());
  for (std::size_t d = 0; d < directions.size(); ++d) {
    basis.evaluate<double>(directions[d].cast<double>(), values);
    std::copy(values.begin(), values.end(), rows.begin() + d * basis.size());
  }
  return rows;
}

}  // namespace kiln
