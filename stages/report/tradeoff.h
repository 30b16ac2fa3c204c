// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "report/records.h"

namespace kiln {

/// Way in which kiln-compress can store an asset.
struct StoredWay {
  std::string scheme;  ///< planes, pca or clustered-pca
  int clusters = 1;
  int components = 0;
  int lookups = 0;
  double error = 0;  ///< expected relighting error
  double bytes_per_texel = 0;
  bool is_feasible = false;

  std::string name() const;  ///< "256 clusters, 4 components"
};

/// Bytes against error, as compress.json has them.
struct Tradeoff {
  StoredWay plain;   ///< planes of 8 bits, and their error
  StoredWay chosen;  ///< as written
  std::vector<StoredWay> tried;
  double target_error = 0;
};

/// Reads a trade-off. Throws BadInput where the record is not what kiln-compress writes.
Tradeoff read_tradeoff(const StageRecord& compress);

/// Plots it over logarithmic axes: an SVG element and its legend. Ways without error, which a logarithmic axis cannot
/// show, are left out.
std::string tradeoff_plot(const Tradeoff& tradeoff);

/// Lists it as rows of a table.
std::string tradeoff_table(const Tradeoff& tradeoff);

}  // namespace kiln
