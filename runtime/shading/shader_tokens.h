// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace kiln {

/// Piece of GLSL.
struct ShaderToken {
  enum class Kind { word, number, text, sign, directive };
  Kind kind = Kind::sign;
  std::string text;       ///< of a directive the whole line; of a text without its quotes
  int line = 1;           ///< line of its first character
  std::size_t begin = 0;  ///< place of its first character, and behind its last
  std::size_t end = 0;
};

/// Replaces comments by blanks; lines stay.
std::string without_comments(std::string text);

/// Splits a text without comments.
std::vector<ShaderToken> shader_tokens(const std::string& text);

}  // namespace kiln
