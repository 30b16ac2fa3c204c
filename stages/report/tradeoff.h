#pragma once

#include <string>
#include <vector>

#include "report/records.h"

namespace kiln {

/// One way that kiln-compress knows to store an asset.
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
  StoredWay plain;   ///< planes of 8 bits, and what they are off by
  StoredWay chosen;  ///< as written
  std::vector<StoredWay> tried;
  double target_error = 0;
};

/// Throws BadInput where the record is not what kiln-compress writes.
Tradeoff read_tradeoff(const StageRecord& compress);

/// A plot over logarithmic axes: an SVG element and its legend. Ways without error, which such an axis has no place
/// for, are left out.
std::string tradeoff_plot(const Tradeoff& tradeoff);

/// The same as rows of a table.
std::string tradeoff_table(const Tradeoff& tradeoff);

}  // namespace kiln
