// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/fbx_text.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "base/errors.h"
#include "import/text_lines.h"

// Text files are lists of "Name: value, value { records }"; ";" begins a comment, and "*24 { a: 1,2 }" is an array.

namespace kiln {

namespace {

constexpr int deepest_block = 50;

class TextParser {
 public:
  TextParser(const FbxDocument& document, std::string_view text) : document_(document), text_(text) {}

  void parse(FbxRecord& root) {
    parse_list(root, 0);
    if (at_ < text_.size()) fail("a brace that closes nothing", "a record");
  }

 private:
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    throw BadInput(document_.file().string() + ":" + std::to_string(line_), found, expected, "export it again");
  }

  [[noreturn]] void truncated() const {
    document_.fail("is truncated at line " + std::to_string(line_), "a whole FBX file", "copy it again");
  }

  bool is_end() const { return at_ >= text_.size(); }
  char here() const { return text_[at_]; }
  void step() { line_ += text_[at_++] == '\n'; }

  /// Skips blanks and comments; also ends of lines where `across_lines`.
  void skip_blanks(bool across_lines) {
    while (!is_end()) {
      if (here() == ';') {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (here() == '\n' ? across_lines : std::isspace(static_cast<unsigned char>(here())) != 0) {
        step();
      } else {
        return;
      }
    }
  }

  void parse_list(FbxRecord& parent, int depth) {
    if (depth > deepest_block) fail("records deeper than " + std::to_string(deepest_block) + " levels", "an FBX file");
    for (skip_blanks(true); !is_end() && here() != '}'; skip_blanks(true)) parse_record(parent, depth);
  }

  void parse_record(FbxRecord& parent, int depth) {
    FbxRecord record;
    record.place = line_;
    const std::size_t begin = at_;
    while (!is_end() && here() != ':' && here() != '\n' && here() != '{' && here() != '}' && here() != '"') ++at_;
    if (is_end()) truncated();
    record.name = trimmed(text_.substr(begin, at_ - begin));
    if (here() != ':' || record.name.empty())
      fail("'" + std::string(record.name.substr(0, 40)) + "'", "a name with a colon behind it");
    ++at_;
    parse_values(record);
    skip_blanks(true);
    if (!is_end() && here() == '{') {
      ++at_;
      if (!parse_array(record)) parse_list(record, depth + 1);
      skip_blanks(true);
      if (is_end()) truncated();
      ++at_;
    }
    parent.children.push_back(std::move(record));
  }

  /// Reads values between commas, up to the end of the line or a brace; after a comma the list continues on the next
  /// line.
  void parse_values(FbxRecord& record) {
    bool goes_on = false;
    while (true) {
      skip_blanks(goes_on);
      if (is_end() || here() == '\n' || here() == '{' || here() == '}') return;
      if (here() == ',') {
        ++at_;
        goes_on = true;
        continue;
      }
      goes_on = false;
      record.values.push_back(here() == '"' ? parse_string() : parse_word());
    }
  }

  FbxValue parse_string() {
    const std::size_t begin = ++at_;
    while (!is_end() && here() != '"') step();
    if (is_end()) truncated();
    FbxValue value;
    value.type = 'S';
    value.bytes = text_.substr(begin, at_ - begin);
    ++at_;
    return value;
  }

  FbxValue parse_word() {
    const std::size_t begin = at_;
    while (!is_end() && std::string_view(" \t\r\n,{}\"").find(here()) == std::string_view::npos) ++at_;
    FbxValue value;
    value.bytes = text_.substr(begin, at_ - begin);
    if (value.bytes.empty()) fail("a sign that begins no value", "a value");
    if (value.bytes.front() == '*') {
      const auto length = parse_integer(value.bytes.substr(1));
      if (!length || *length < 0 || *length > 0xFFFFFFFFll)
        fail("'" + std::string(value.bytes) + "'", "an array's size");
      value.type = 'a';
      value.length = static_cast<std::uint32_t>(*length);
      value.bytes = {};
      return value;
    }
    if (const auto whole = parse_integer(value.bytes)) {
      value.whole = *whole;
      value.number = static_cast<double>(*whole);
    } else if (const auto number = parse_number(value.bytes)) {
      value.type = 'D';
      value.number = *number;
    } else {
      value.type = 'W';
    }
    return value;
  }

  /// Reads the numbers of an array, up to its brace. False where the record is not an array.
  bool parse_array(FbxRecord& record) {
    if (record.values.empty() || record.values.front().type != 'a') return false;
    skip_blanks(true);
    if (is_end()) truncated();
    if (here() == '}') return true;
    if (!text_.substr(at_).starts_with("a:")) fail("an array without numbers", "\"a:\" and numbers");
    at_ += 2;
    const std::size_t begin = at_;
    while (!is_end() && here() != '}') step();
    record.values.front().bytes = text_.substr(begin, at_ - begin);
    return true;
  }

  const FbxDocument& document_;
  std::string_view text_;
  std::size_t at_ = 0, line_ = 1;
};

}  // namespace

void parse_fbx_text(const FbxDocument& document, std::string_view text, FbxRecord& root) {
  TextParser(document, text).parse(root);
}

}  // namespace kiln
