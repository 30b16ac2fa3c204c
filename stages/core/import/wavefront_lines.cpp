// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/wavefront_lines.h"

#include <algorithm>

namespace kiln {

namespace {

/// Tells whether the # at `position` belongs to "1.#INF", "1.#IND", "1.#QNAN" or "1.#SNAN".
bool is_no_number(std::string_view line, std::size_t position) {
  if (position == 0 || line[position - 1] != '.') return false;
  const std::string_view rest = line.substr(position + 1);
  return rest.starts_with("INF") || rest.starts_with("IND") || rest.starts_with("QNAN") || rest.starts_with("SNAN");
}

/// Tells whether a line continues on the next: its last character, apart from blanks, is a backslash outside a comment.
bool goes_on(std::string_view line) {
  const std::size_t last = line.find_last_not_of(" \t\f\v");
  return last != std::string_view::npos && line[last] == '\\' && name_without_comment(line).size() == line.size();
}

}  // namespace

bool WavefrontLines::next(std::string_view& statement) {
  if (!lines_.next(statement)) return false;
  line_ = lines_.number();
  const char* const end = statement.data() + statement.size();
  ends_in_line_end_ = lines_.rest().data() != end;
  if (!statement.empty() && (statement.back() == '\\' || is_blank(statement.back())) && goes_on(statement))
    join(statement);
  return true;
}

void WavefrontLines::join(std::string_view& statement) {
  joined_.clear();
  bool more = true;
  while (more) {
    more = goes_on(statement);
    joined_ += statement.substr(0, more ? statement.rfind('\\') : statement.size());
    joined_ += ' ';
    if (!more || !lines_.next(statement)) break;
    ends_in_line_end_ = lines_.rest().data() != statement.data() + statement.size();
  }
  statement = joined_;
}

std::string_view without_comment(std::string_view numbers) {
  std::size_t position = numbers.find('#');
  while (position != std::string_view::npos && is_no_number(numbers, position))
    position = numbers.find('#', position + 1);
  return numbers.substr(0, position);
}

std::string_view name_without_comment(std::string_view name) {
  if (name.find('#') == std::string_view::npos) return name;
  bool in_quotes = false;
  for (std::size_t k = 0; k < name.size(); ++k) {
    if (name[k] == '"') in_quotes = !in_quotes;
    if (name[k] == '#' && !in_quotes && (k == 0 || is_blank(name[k - 1]))) return name.substr(0, k);
  }
  return name;
}

std::string_view unquoted(std::string_view name) {
  name = trimmed(name);
  if (name.size() < 2 || (name.front() != '"' && name.front() != '\'') || name.back() != name.front()) return name;
  return name.substr(1, name.size() - 2);
}

std::string_view next_name(std::string_view& rest) {
  std::string_view text = trimmed(rest);
  const std::size_t end = text.starts_with('"') ? text.find('"', 1) : std::string_view::npos;
  if (end == std::string_view::npos) return next_word(rest);
  rest = text.substr(end + 1);
  return text.substr(1, end - 1);
}

std::string shown(std::string_view text) {
  constexpr std::size_t longest = 60;
  std::string result(text.substr(0, longest));
  for (char& c : result)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = c == '\t' ? ' ' : '?';
  return "'" + result + (text.size() > longest ? "...'" : "'");
}

}  // namespace kiln
