// SPDX-License-Identifier: MIT
#include "sh/transfer_sums.h"

#include <cassert>

namespace kiln {

void TransferSums::add(const TransferSums& other) {
  assert(receivers == other.receivers && coefficients == other.coefficients);
  for (std::size_t k = 0; k < values.size(); ++k) values[k] += other.values[k];
  directions += other.directions;
}

TransferVectors TransferSums::transfer() const {
  TransferVectors transfer(receivers, coefficients);
  if (directions == 0) return transfer;
  const double weight = 4.0 / (static_cast<double>(directions) * fixed_point_one);
  for (std::size_t k = 0; k < values.size(); ++k)
    transfer.values[k] = static_cast<float>(weight * static_cast<double>(values[k]));
  return transfer;
}

}  // namespace kiln
