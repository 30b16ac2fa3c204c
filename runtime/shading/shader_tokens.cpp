// SPDX-License-Identifier: MIT
#include "runtime/shading/shader_tokens.h"

#include <cctype>

namespace kiln {

namespace {

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// Finds the end of a number: digits, a point, an exponent with its sign, a suffix.
std::size_t end_of_number(const std::string& text, std::size_t at) {
  const auto in_number = [&](std::size_t k) {
    const char c = text[k];
    if (is_letter(c) || is_digit(c) || c == '.') return true;
    return (c == '+' || c == '-') && (text[k - 1] == 'e' || text[k - 1] == 'E');
  };
  while (at < text.size() && in_number(at)) ++at;
  return at;
}

}  // namespace

std::string without_comments(std::string text) {
  const auto blank = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      if (text[k] != '\n') text[k] = ' ';
  };
  for (std::size_t k = 0; k + 1 < text.size();) {
    if (text[k] == '/' && text[k + 1] == '/') {
      const std::size_t end = std::min(text.find('\n', k), text.size());
      blank(k, end);
      k = end;
    } else if (text[k] == '/' && text[k + 1] == '*') {
      const std::size_t found = text.find("*/", k + 2);
      const std::size_t end = found == std::string::npos ? text.size() : found + 2;
      blank(k, end);
      k = end;
    } else {
      ++k;
    }
  }
  return text;
}

std::vector<ShaderToken> shader_tokens(const std::string& text) {
  using Kind = ShaderToken::Kind;
  std::vector<ShaderToken> tokens;
  int line = 1;
  bool at_line_start = true;
  for (std::size_t k = 0; k < text.size();) {
    const char c = text[k];
    if (c == '\n') {
      ++line;
      at_line_start = true;
      ++k;
      continue;
    }
    if (std::isspace(static_cast<unsigned char>(c)) != 0) {
      ++k;
      continue;
    }
    ShaderToken token{Kind::sign, "", line, k, k + 1};
    if (c == '#' && at_line_start) {
      token.kind = Kind::directive;
      token.end = std::min(text.find('\n', k), text.size());
    } else if (is_letter(c)) {
      token.kind = Kind::word;
      while (token.end < text.size() && (is_letter(text[token.end]) || is_digit(text[token.end]))) ++token.end;
    } else if (is_digit(c) || (c == '.' && k + 1 < text.size() && is_digit(text[k + 1]))) {
      token.kind = Kind::number;
      token.end = end_of_number(text, k + 1);
    } else if (c == '"') {
      token.kind = Kind::text;
      token.end = std::min(text.find_first_of("\"\n", k + 1), text.size());
      token.text = text.substr(k + 1, token.end - k - 1);
      if (token.end < text.size() && text[token.end] == '"') ++token.end;
    }
    if (token.kind != Kind::text) token.text = text.substr(k, token.end - k);
    at_line_start = false;
    k = token.end;
    tokens.push_back(std::move(token));
  }
  return tokens;
}

}  // namespace kiln
