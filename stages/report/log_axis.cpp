// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/log_axis.h"

#include <algorithm>
#include <cmath>

namespace kiln {

LogAxis::LogAxis(const std::vector<double>& values, double at_low, double at_high, Layout layout)
    : at_low_(at_low), at_high_(at_high), widest_(layout.widest) {
  const auto [least, most] = std::ranges::minmax(values);
  low_ = least / layout.margin;
  high_ = most * layout.margin;
}

double LogAxis::place(double value) const {
  return at_low_ + (at_high_ - at_low_) * std::log(value / low_) / std::log(high_ / low_);
}

std::vector<double> LogAxis::ticks() const {
  std::vector<double> all;
  const bool is_wide = high_ / low_ > widest_;
  for (int power = static_cast<int>(std::floor(std::log10(low_))); std::pow(10.0, power) <= high_; ++power)
    for (const int times : {1, 2, 5})
      if (const double value = times * std::pow(10.0, power);
          value >= low_ && value <= high_ && (times == 1 || !is_wide))
        all.push_back(value);
  return all;
}

}  // namespace kiln
