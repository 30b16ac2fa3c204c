#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "import/text_lines.h"

namespace kiln {

/// The statements of a Wavefront file (OBJ and MTL): lines, of which a backslash at the end joins the next. Lines that
/// begin with # are given too, and joined with nothing.
class WavefrontLines {
 public:
  explicit WavefrontLines(std::string_view text) : lines_(text) {}

  /// Moves to the next statement, which stays valid until the next call. False where there is none.
  bool next(std::string_view& statement);

  /// The line that the statement begins in, from 1.
  std::uint32_t line() const { return line_; }

  /// Whether the file ends within the statement: nothing stands behind it, not even the end of a line.
  bool is_cut_off() const { return lines_.rest().empty() && !ends_in_line_end_; }

 private:
  void join(std::string_view& statement);

  TextLines lines_;
  std::string joined_;
  std::uint32_t line_ = 0;
  bool ends_in_line_end_ = false;
};

/// Whether a word is that keyword, which is given in lower case, in any case of letters.
bool is_keyword(std::string_view word, std::string_view lower_case);

/// A statement of numbers without a comment behind it. A # within "1.#QNAN" and its like, as Windows writes what is no
/// number, begins none.
std::string_view without_comment(std::string_view numbers);

/// A name that may hold blanks, without a comment behind it: a # that begins a word, outside of quotes.
std::string_view name_without_comment(std::string_view name);

/// A name without blanks around it, and without quotes where it stands in quotes.
std::string_view unquoted(std::string_view name);

/// A name that may stand in quotes at the beginning of `rest`, which is cut off: to the closing quote, or a word.
std::string_view next_name(std::string_view& rest);

/// "'TEXT'" for messages, shortened where it is long, with a question mark for each byte that cannot be shown.
std::string shown(std::string_view text);

}  // namespace kiln
