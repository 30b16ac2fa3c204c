// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace kiln {

/// Logarithmic axis of a plot.
class LogAxis {
 public:
  /// Room beyond the values, a factor, and the ratio of the axis's ends above which only powers of ten have ticks.
  struct Layout {
    double margin = 1.25, widest = 3e2;
  };

  /// Spans values, all above 0, between two places of the plot.
  LogAxis(const std::vector<double>& values, double at_low, double at_high, Layout layout);

  /// Returns where a value lies.
  double place(double value) const;

  /// Returns 1, 2 and 5 times powers of ten; only the powers where those would be too many.
  std::vector<double> ticks() const;

 private:
  double low_, high_, at_low_, at_high_, widest_;
};

}  // namespace kiln
