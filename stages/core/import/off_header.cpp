// SPDX-License-Identifier: GPL-3.0-or-later
// The header of OFF files after the Geomview manual, "OFF Files" (geomview.org/docs/html/OFF.html). Files of ModelNet40
// have the first number stuck to the keyword, others leave out the number of edges or the keyword.

#include "import/off_header.h"

#include <algorithm>

#include "base/errors.h"
#include "import/readers.h"
#include "import/text_lines.h"
#include "import/text_words.h"

namespace kiln {

namespace {

class OffHeaderReader {
 public:
  OffHeaderReader(const std::string& file, std::string_view text)
      : file_(file), text_(text), words_(file, without_byte_order_mark(text), 1, '#') {}

  OffHeader read() {
    if (!words_.to_word()) throw BadInput(file_, "is empty", "an OFF file", "check what file it is");
    std::string_view word = words_.next_on_line();
    if (!parse_integer(word)) word = read_keyword(word);
    if (header_.is_binary)
      skip_line_end();
    else
      read_counts(word);
    header_.size = text_.size() - words_.rest().size();
    header_.line = words_.line();
    return header_;
  }

 private:
  /// Reads the keyword; returns the word after it on the same line, or the number attached to it.
  std::string_view read_keyword(std::string_view word) {
    constexpr std::string_view keyword = "OFF";
    const auto* const end = std::search(word.begin(), word.end(), keyword.begin(), keyword.end(), [](char a, char b) {
      return same_word({&a, 1}, {&b, 1});
    });
    const auto prefix = word.substr(0, static_cast<std::size_t>(end - word.begin()));
    std::string_view stuck = word.substr(std::min(prefix.size() + 3, word.size()));
    if (end == word.end() || !read_prefix(prefix, word) || (!stuck.empty() && !parse_integer(stuck)))
      throw BadInput(words_.where(), "begins with " + in_quotes(word), "an OFF file, whose first word is 'OFF'",
                     "check what file it is");
    if (!stuck.empty()) return stuck;
    const std::string_view next = words_.next_on_line();
    header_.is_binary = same_word(next, "BINARY");
    return next;
  }

  /// Reads the letters before OFF in `word`. False for unknown ones.
  bool read_prefix(std::string_view prefix, std::string_view word) {
    const bool is_small = std::ranges::none_of(word, [](char c) { return c >= 'A' && c <= 'Z'; });
    for (std::size_t i = 0; i < prefix.size(); ++i) {
      const char c = prefix[i];
      if (same_word(prefix.substr(i, 2), "ST")) {
        header_.has_uvs = true;
        ++i;
      } else if (c == 'n' && !(is_small && prefix.size() > 1)) {
        throw BadInput(words_.where(), "vertices of any number of dimensions ('nOFF')", "vertices of three coordinates",
                       "export the mesh as plain OFF");
      } else if (c == 'N' || c == 'n') {
        header_.has_normals = true;
      } else if (c == 'C' || c == 'c') {
        header_.has_colors = true;
      } else if (c == '4') {
        header_.has_weights = true;
      } else {
        return false;
      }
    }
    return true;
  }

  /// Moves past the end of the line that says BINARY.
  void skip_line_end() {
    words_.skip_line();
    const std::string_view rest = words_.rest();
    const std::size_t size = rest.starts_with("\r\n") ? 2 : std::min<std::size_t>(1, rest.size());
    words_ = TextWords(file_, rest.substr(size), words_.line() + 1);
  }

  std::uint64_t count_of(std::string_view word, const std::string& name) const {
    const auto count = parse_integer(word);
    if (count && *count >= 0) return static_cast<std::uint64_t>(*count);
    if (word.empty())
      throw BadInput(file_, "is truncated: it ends before the number of " + name, "a whole OFF file", export_again);
    throw BadInput(words_.where(), "the number of " + name + " is " + in_quotes(word), "a whole number, 0 or more",
                   export_again);
  }

  void read_counts(std::string_view word) {
    if (word.empty()) word = words_.next();
    header_.vertex_count = count_of(word, "vertices");
    const std::uint32_t line = words_.line();
    word = words_.next();
    header_.face_count = count_of(word, "faces");
    const bool one_a_line = words_.line() != line;
    word = words_.next_on_line();
    if (!word.empty())
      count_of(word, "edges");
    else if (one_a_line)
      skip_edges_line();
    if (!words_.next_on_line().empty())
      throw BadInput(words_.where(), "more than three numbers", "the numbers of vertices, faces and edges",
                     export_again);
  }

  /// Skips a line of one number, the number of edges.
  void skip_edges_line() {
    TextWords ahead = words_;
    if (ahead.next().empty() || !ahead.next_on_line().empty()) return;
    words_ = ahead;
  }

  const std::string& file_;
  std::string_view text_;
  TextWords words_;
  OffHeader header_;
};

}  // namespace

OffHeader read_off_header(const std::string& file, std::string_view text) { return OffHeaderReader(file, text).read(); }

}  // namespace kiln
