// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/nearest.h"

#include <algorithm>
#include <numeric>

namespace kiln {

namespace {

/// Counts the letters to insert, remove or exchange [Levenshtein 1966].
std::size_t changes_between(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0u : 1u)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

}  // namespace

std::string nearest_of(const std::string& word, const std::vector<std::string>& words) {
  std::string nearest;
  std::size_t fewest = word.size() / 2 + 1;
  for (const std::string& candidate : words)
    if (const std::size_t changes = changes_between(word, candidate); changes < fewest) {
      fewest = changes;
      nearest = candidate;
    }
  return nearest;
}

}  // namespace kiln
