// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/text_lines.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <string>

namespace kiln {

namespace {

/// Returns a word without the plus sign before its number, which from_chars does not accept.
std::string_view without_plus(std::string_view word) {
  const bool has_plus = word.size() > 1 && word[0] == '+' && word[1] != '-' && word[1] != '+';
  return has_plus ? word.substr(1) : word;
}

}  // namespace

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view mark = "\xef\xbb\xbf";
  return text.starts_with(mark) ? text.substr(mark.size()) : text;
}

TextLines::TextLines(std::string_view text) : rest_(without_byte_order_mark(text)) { find_feed(); }

void TextLines::find_feed() {
  const std::size_t feed = rest_.find('\n');
  feed_ = rest_.data() + std::min(feed, rest_.size());
}

bool TextLines::next(std::string_view& line) {
  if (rest_.empty()) return false;
  // Search for a line feed only once, though carriage returns may end many lines before it.
  const std::string_view before_feed(rest_.data(), static_cast<std::size_t>(feed_ - rest_.data()));
  line = before_feed.substr(0, before_feed.find('\r'));
  rest_.remove_prefix(line.size());
  const bool is_return = rest_.starts_with('\r');
  if (is_return) rest_.remove_prefix(1);
  if (rest_.data() == feed_) {
    if (!rest_.empty()) rest_.remove_prefix(1);
    find_feed();
  }
  ++number_;
  return true;
}

std::string_view next_word(std::string_view& line) {
  const char* begin = line.data();
  const char* const end = begin + line.size();
  while (begin != end && is_blank(*begin)) ++begin;
  const char* word_end = begin;
  while (word_end != end && !is_blank(*word_end)) ++word_end;
  line.remove_prefix(static_cast<std::size_t>(word_end - line.data()));
  return {begin, static_cast<std::size_t>(word_end - begin)};
}

std::string_view trimmed(std::string_view line) {
  while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
  while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
  return line;
}

std::optional<double> parse_number(std::string_view word) {
  const std::string_view digits = without_plus(word);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (end != digits.data() + digits.size() || digits.empty()) return std::nullopt;
  if (error == std::errc::result_out_of_range) return std::strtod(std::string(digits).c_str(), nullptr);
  if (error != std::errc()) return std::nullopt;
  return value;
}

std::optional<std::int64_t> parse_integer(std::string_view word) {
  const std::string_view digits = without_plus(word);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || digits.empty()) return std::nullopt;
  return value;
}

int significant_digits(std::string_view word) {
  int digits = 0;
  for (const char c : word) {
    if (c == 'e' || c == 'E') break;
    if (c < '0' || c > '9') continue;
    if (digits > 0 || c != '0') ++digits;
  }
  return digits;
}

std::string counted(std::uint64_t count, const std::string& what, const std::string& plural) {
  return std::to_string(count) + " " + (count == 1 ? what : plural.empty() ? what + "s" : plural);
}

}  // namespace kiln
