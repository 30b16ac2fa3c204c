// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace kiln {

/// Weight of a vertex, or the weights of several that became one.
struct VertexWeight {
  double sum = 1;    ///< of the vertices' weights
  double count = 1;  ///< vertices that became this one

  double mean() const { return sum / count; }
  VertexWeight& operator+=(const VertexWeight& other) {
    sum += other.sum;
    count += other.count;
    return *this;
  }
};

}  // namespace kiln
