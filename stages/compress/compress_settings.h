// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "base/options.h"

namespace kiln {

struct CompressSettings {
  std::string max_error = "auto";  ///< expected relighting error, or auto: that of planes of 8 bits
  int clusters = 0;                ///< 1 to 256; 1 is plain PCA; 0: the cheapest
  int components = 0;              ///< basis vectors per cluster; 0: the cheapest
  int gutter = 4;  ///< width in texels of the gutter that is kept; texels further away are never looked up
  int seed = 1;    ///< for the first clusters; --seed, common to all stages
};

OptionSet compress_options(CompressSettings& settings);

/// Returns the error that was asked for; none for "auto". Throws WrongUsage.
std::optional<double> target_error(const CompressSettings& settings);

}  // namespace kiln
