#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kiln {

/// The lines of a text, whatever ends them: line feed, carriage return or both. A byte order mark is passed by.
class TextLines {
 public:
  explicit TextLines(std::string_view text);

  /// Moves to the next line, without its end. False where there is none.
  bool next(std::string_view& line);

  /// The number of the line that next() gave, from 1.
  std::uint32_t number() const { return number_; }

  /// What stands behind that line.
  std::string_view rest() const { return rest_; }

 private:
  void find_feed();

  std::string_view rest_;
  const char* feed_ = nullptr;  ///< the first line feed of `rest_`, or its end
  std::uint32_t number_ = 0;
};

/// Whether a character parts words: space, tab, form feed, vertical tab or carriage return.
constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\f' || c == '\v' || c == '\r'; }

/// Cuts the next word off a line; blanks are spaces, tabs, form feeds and vertical tabs. Empty where there is none.
std::string_view next_word(std::string_view& line);

/// A line without the blanks around it.
std::string_view trimmed(std::string_view line);

/// The number that a whole word stands for, in the C locale, a plus sign before it allowed; NaN and infinities are
/// numbers here. Nothing for other words, such as "0,5". Numbers too large for a double are infinite, too small ones 0.
std::optional<double> parse_number(std::string_view word);

/// The same for whole numbers, a plus sign before them allowed.
std::optional<std::int64_t> parse_integer(std::string_view word);

/// How many significant decimal digits a number is written with: 4 for "-0.01234" and for "1.234e5".
int significant_digits(std::string_view word);

/// A count and what is counted: "1 face", "12 faces". `plural` is needed where it is not the word with an s.
std::string counted(std::uint64_t count, const std::string& what, const std::string& plural = "");

}  // namespace kiln
