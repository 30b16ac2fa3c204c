// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/text_words.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "base/errors.h"
#include "import/readers.h"
#include "import/text_lines.h"

namespace kiln {

namespace {

/// Tells whether a character is a blank; a carriage return is not, since it ends a line.
bool is_gap(char c) { return c == ' ' || c == '\t' || c == '\f' || c == '\v'; }
bool is_line_end(char c) { return c == '\n' || c == '\r'; }

/// Parses NaN and infinities as old C libraries of Windows write them: "-1.#IND", "1.#QNAN", "1.#INF000".
std::optional<double> parse_old_nan(std::string_view word) {
  const bool negative = word.starts_with('-');
  if (negative || word.starts_with('+')) word.remove_prefix(1);
  if (!word.starts_with("1.#")) return std::nullopt;
  if (word.substr(3).starts_with("INF")) return negative ? -HUGE_VAL : HUGE_VAL;
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

bool TextWords::to_word() {
  const char* at = rest_.data();
  const char* const end = at + rest_.size();
  while (at != end) {
    if (is_gap(*at)) {
      ++at;
    } else if (is_line_end(*at)) {
      at += *at == '\r' && at + 1 != end && at[1] == '\n' ? 2 : 1;
      ++line_;
    } else if (comment_ != '\0' && *at == comment_) {
      while (at != end && !is_line_end(*at)) ++at;
    } else {
      break;
    }
  }
  rest_.remove_prefix(static_cast<std::size_t>(at - rest_.data()));
  return !rest_.empty();
}

std::string_view TextWords::next_on_line() {
  const char* begin = rest_.data();
  const char* const end = begin + rest_.size();
  while (begin != end && is_gap(*begin)) ++begin;
  const char* stop = begin;
  while (stop != end && !is_gap(*stop) && !is_line_end(*stop) && (comment_ == '\0' || *stop != comment_)) ++stop;
  rest_.remove_prefix(static_cast<std::size_t>(stop - rest_.data()));
  return {begin, static_cast<std::size_t>(stop - begin)};
}

void TextWords::skip_line() { rest_.remove_prefix(std::min(rest_.find_first_of("\r\n"), rest_.size())); }

double TextWords::number(std::string_view word) const {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error == std::errc() && end == word.data() + word.size()) return value;
  if (const auto number = parse_number(word)) return *number;
  if (const auto number = parse_old_nan(word)) return *number;
  if (word.find(',') != std::string_view::npos)
    throw BadInput(where(), "the word " + in_quotes(word) + " is no number",
                   "a number with a decimal point, such as 0.5", "export the mesh again with decimal points");
  throw BadInput(where(), "the word " + in_quotes(word) + " is no number", "a number such as 0.5", export_again);
}

double TextWords::whole_number(std::string_view word) const {
  const double value = number(word);
  constexpr double limit = 9007199254740992.0;  // 2^53
  if (value == std::trunc(value) && std::abs(value) < limit) return value;
  throw BadInput(where(), "the word " + in_quotes(word) + " is no whole number", "a whole number", export_again);
}

std::uint64_t count_lines_with_words(std::string_view text) {
  std::uint64_t count = 0;
  bool has_word = false;
  for (const char c : text) {
    if (is_line_end(c)) {
      count += has_word;
      has_word = false;
    } else {
      has_word |= !is_gap(c);
    }
  }
  return count + has_word;
}

std::string in_quotes(std::string_view word) {
  constexpr std::size_t longest = 40;
  std::string text(word.substr(0, longest));
  for (char& c : text)
    if (c < ' ' || c == 0x7f) c = '?';
  return "'" + text + (word.size() > longest ? "...'" : "'");
}

bool same_word(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](char x, char y) { return in_lower_case(x) == in_lower_case(y); });
}

}  // namespace kiln
