#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "import/text_lines.h"

namespace kiln {

/// The words of a mesh file's text, one after another, over the ends of lines or line by line. Lines end with a line
/// feed, a carriage return or both; blanks are spaces, tabs, form feeds and vertical tabs.
class TextWords {
 public:
  /// `file` is for messages; it and the text are not copied. The text begins in line `first_line`. What follows the
  /// character `comment` on a line is passed by; 0: there is no such character.
  TextWords(std::string_view file, std::string_view text, std::uint32_t first_line = 1, char comment = '\0')
      : file_(file), rest_(text), line_(first_line), comment_(comment) {}

  /// Moves to the next word, on this line or a later one. False where there is none.
  bool to_word();

  /// Cuts the next word off this line. Empty at its end.
  std::string_view next_on_line();

  /// Cuts the next word off, whatever its line. Empty at the end of the text.
  std::string_view next() { return to_word() ? next_on_line() : std::string_view(); }

  /// Moves to the end of this line, and before the next.
  void skip_line();

  std::uint32_t line() const { return line_; }
  std::string_view rest() const { return rest_; }

  /// "scan.ply:12", of this line.
  std::string where() const { return std::string(file_) + ":" + std::to_string(line_); }

  /// The number that a word of this line stands for; NaN and infinities are numbers here. Throws BadInput, with the
  /// line and the word, for other words, such as "0,5".
  double number(std::string_view word) const;

  /// The same for whole numbers below 2^53 in size; "3.0" is one.
  double whole_number(std::string_view word) const;

 private:
  std::string_view file_, rest_;
  std::uint32_t line_;
  char comment_;
};

/// How many lines of a text have words.
std::uint64_t count_lines_with_words(std::string_view text);

/// A word between quotation marks, as it is shown in a message: cut where it is long, bytes that are no text as '?'.
std::string in_quotes(std::string_view word);

/// Whether two words are the same but for capital letters, of ASCII.
bool same_word(std::string_view a, std::string_view b);

}  // namespace kiln
