// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "import/text_lines.h"

namespace kiln {

/// Words of a mesh file's text, one after another, across lines or line by line. Lines end with a line feed, a carriage
/// return or both; blanks are spaces, tabs, form feeds and vertical tabs.
class TextWords {
 public:
  /// `file` appears in messages; neither it nor the text is copied. The text begins in line `first_line`. Text after
  /// the character `comment` on a line is skipped; 0: there is no such character.
  TextWords(std::string_view file, std::string_view text, std::uint32_t first_line = 1, char comment = '\0')
      : file_(file), rest_(text), line_(first_line), comment_(comment) {}

  /// Moves to the next word, on this line or a later one. False where there is none.
  bool to_word();

  /// Removes the next word from this line. Empty at its end.
  std::string_view next_on_line();

  /// Removes the next word, on whatever line. Empty at the end of the text.
  std::string_view next() { return to_word() ? next_on_line() : std::string_view(); }

  /// Moves to the end of this line, before the next.
  void skip_line();

  std::uint32_t line() const { return line_; }
  std::string_view rest() const { return rest_; }

  /// Returns "scan.ply:12" for this line.
  std::string where() const { return std::string(file_) + ":" + std::to_string(line_); }

  /// Parses a word of this line as a number; NaN and infinities count as numbers. Throws BadInput, with the line and
  /// the word, for other words, such as "0,5".
  double number(std::string_view word) const;

  /// Parses a whole number with an absolute value below 2^53; "3.0" is one.
  double whole_number(std::string_view word) const;

 private:
  std::string_view file_, rest_;
  std::uint32_t line_;
  char comment_;
};

/// Counts the lines of a text that have words.
std::uint64_t count_lines_with_words(std::string_view text);

/// Quotes a word for a message: cut if long, with '?' for bytes that are not text.
std::string in_quotes(std::string_view word);

/// Tells whether two words are equal except for capital letters, of ASCII.
bool same_word(std::string_view a, std::string_view b);

}  // namespace kiln
