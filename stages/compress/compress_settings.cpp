// SPDX-License-Identifier: GPL-3.0-or-later
#include "compress/compress_settings.h"

#include <charconv>

#include "base/errors.h"
#include "base/number_text.h"

namespace kiln {

OptionSet compress_options(CompressSettings& settings) {
  OptionSet options;
  options
      .typed<std::optional<double>>(
          "max-error", settings.max_error, "auto or 1e-06 to 1",
          "Expected relighting error against the input that the result stays under, 1e-6 to 1, or auto: what planes "
          "of 8 bits have against planes of more. Whatever it is, 999 of 1,000 texels stay under an error of 0.07, and "
          "999 of 1,000 jumps of it where clusters meet under 0.11, so that no blotch and no border shows; where "
          "--clusters and --pca leave no choice, a miss is warned of",
          parse_compression_error,
          [](const std::optional<double>& error) { return error ? numbers_text({*error}) : "auto"; })
      .integer_or_auto("clusters", settings.clusters, 1, 256,
                       "Clusters of texels, each with a basis of its own; 1: one basis for all; auto: what is cheapest")
      .integer_or_auto("pca", settings.components, 1, 256,
                       "Basis vectors of a cluster, so many weights per texel; auto: what is cheapest")
      .integer("gutter", settings.gutter, 1, 64,
               "Texels around charts that keep their values; those beyond are filled with what costs least");
  return options;
}

std::optional<double> parse_compression_error(const std::string& text) {
  if (text == "auto") return std::nullopt;
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [rest, fault] = std::from_chars(text.data(), end, value);
  if (fault != std::errc() || rest != end || !(value >= 1e-6 && value <= 1))
    throw WrongUsage("max-error: found '" + text + "'; expected auto, or a number of 1e-6 to 1");
  return value;
}

}  // namespace kiln
