// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/planes/quantisation_floor.h"

#include <algorithm>
#include <cmath>

namespace kiln {

double quantisation_floor(const TransferVectors& transfer, int bits) {
  return quantisation_floor(std::span(&transfer, 1), bits);
}

double quantisation_floor(std::span<const TransferVectors> channels, int bits) {
  double error = 0, reference = 0;
  for (const TransferVectors& transfer : channels)
    for (int i = 0; i < transfer.coefficients; ++i) {
      const std::span<const float> plane = transfer.plane(i);
      if (plane.empty()) return 0;
      const auto [lowest, highest] = std::minmax_element(plane.begin(), plane.end());
      const double step = (static_cast<double>(*highest) - *lowest) / ((1 << bits) - 1);
      error += static_cast<double>(plane.size()) * step * step / 12;
      for (float value : plane) reference += static_cast<double>(value) * value;
    }
  return reference > 0 ? std::sqrt(error / reference) : 0;
}

}  // namespace kiln
