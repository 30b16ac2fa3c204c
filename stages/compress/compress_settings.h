// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "base/options.h"

namespace kiln {

struct CompressSettings {
  std::optional<double> max_error;  ///< expected relighting error; nothing: what planes of 8 bits have
  int clusters = 0;                 ///< 1 to 256; 1 is plain PCA; 0: what is cheapest
  int components = 0;               ///< basis vectors per cluster; 0: what is cheapest
  int gutter = 4;                   ///< texels around a chart that are kept; those further off are never looked up
  int seed = 1;                     ///< of the first clusters; --seed, common to all stages
};

OptionSet compress_options(CompressSettings& settings);

/// Parses the text of --max-error; returns nothing for "auto". Throws WrongUsage.
std::optional<double> parse_compression_error(const std::string& text);

}  // namespace kiln
