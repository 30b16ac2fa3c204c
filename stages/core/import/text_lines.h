// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kiln {

/// Returns a text without the byte order mark of UTF-8 that may precede it.
std::string_view without_byte_order_mark(std::string_view text);

/// Lines of a text, ended by a line feed, a carriage return or both. A byte order mark is skipped.
class TextLines {
 public:
  explicit TextLines(std::string_view text);

  /// Reads the next line, without its end. False where there is none.
  bool next(std::string_view& line);

  /// Returns the number of the line that next() gave, from 1.
  std::uint32_t number() const { return number_; }

  /// Returns the text after that line.
  std::string_view rest() const { return rest_; }

 private:
  void find_feed();

  std::string_view rest_;
  const char* feed_ = nullptr;  ///< first line feed of `rest_`, or its end
  std::uint32_t number_ = 0;
};

/// Tells whether a character separates words: space, tab, form feed, vertical tab or carriage return.
constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\f' || c == '\v' || c == '\r'; }

/// Returns a letter of ASCII in lower case, and any other character as it is.
constexpr char in_lower_case(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Removes the next word from a line; blanks are spaces, tabs, form feeds and vertical tabs. Empty where there is none.
std::string_view next_word(std::string_view& line);

/// Returns a line without the blanks around it.
std::string_view trimmed(std::string_view line);

/// Parses a whole word as a number, in the C locale, optionally with a plus sign; NaN and infinities count as numbers.
/// Nothing for other words, such as "0,5". Numbers too large for a double become infinite, too small ones 0.
std::optional<double> parse_number(std::string_view word);

/// Parses a whole number, optionally with a plus sign.
std::optional<std::int64_t> parse_integer(std::string_view word);

/// Counts the significant decimal digits that a number is written with: 4 for "-0.01234" and for "1.234e5".
int significant_digits(std::string_view word);

/// Writes a count and what is counted: "1 face", "12 faces". `plural` is needed where it is not the word with an s.
std::string counted(std::uint64_t count, const std::string& what, const std::string& plural = "");

}  // namespace kiln
