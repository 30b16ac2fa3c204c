// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "import/text_lines.h"

namespace kiln {

/// Statements of a Wavefront file (OBJ and MTL): lines, which a backslash at the end joins to the next. Lines that
/// begin with # are returned too, never joined.
class WavefrontLines {
 public:
  explicit WavefrontLines(std::string_view text) : lines_(text) {}

  /// Moves to the next statement, which stays valid until the next call. False where there is none.
  bool next(std::string_view& statement);

  /// Returns the line that the statement begins in, from 1.
  std::uint32_t line() const { return line_; }

  /// Tells whether the file ends within the statement, without even the end of a line.
  bool is_cut_off() const { return lines_.rest().empty() && !ends_in_line_end_; }

 private:
  void join(std::string_view& statement);

  TextLines lines_;
  std::string joined_;
  std::uint32_t line_ = 0;
  bool ends_in_line_end_ = false;
};

/// Returns a statement of numbers without the comment after it. A # within "1.#QNAN" and the like, which Windows writes
/// for NaN, does not begin a comment.
std::string_view without_comment(std::string_view numbers);

/// Returns a name, which may hold blanks, without the comment after it: a # that begins a word, outside of quotes.
std::string_view name_without_comment(std::string_view name);

/// Returns a name without blanks around it, and without quotes if it is quoted.
std::string_view unquoted(std::string_view name);

/// Removes and returns a name at the beginning of `rest`: up to the closing quote if quoted, else a word.
std::string_view next_name(std::string_view& rest);

/// Returns "'TEXT'" for messages, shortened if long, with a question mark for each byte that cannot be shown.
std::string shown(std::string_view text);

}  // namespace kiln
