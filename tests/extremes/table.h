// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace kiln::extremes {

/// What became of an extreme.
enum class Verdict {
  holds,    ///< within the bound
  refused,  ///< refused in so many words, as it must be
  misses,   ///< neither: a defect
  stated,   ///< a measurement without a bound, such as a time
};

/// One measurement.
struct Row {
  std::string what, extreme, measured, bound;
  Verdict verdict = Verdict::misses;

  /// Makes a row that holds where `value` is at most `bound`; a value that is not a number misses.
  static Row at_most(std::string what, std::string extreme, const std::string& quantity, double value, double bound);
};

/// Measurements of one subject, with what they teach.
struct Table {
  std::string title, finding;  ///< the finding is one sentence
  std::vector<Row> rows;
  std::string notes;  ///< paragraphs below the table, may be empty

  bool is_missed() const;
};

/// Formats a number with three significant digits.
std::string number(double value);

/// Formats a whole number in groups of three digits.
std::string grouped(long long value);

/// Formats a table as Markdown.
std::string to_markdown(const Table& table);

/// Formats the page of all tables, the machine named.
std::string to_page(const std::vector<Table>& tables);

}  // namespace kiln::extremes
