// SPDX-License-Identifier: MIT
#include "yaml/yaml_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>
#include <sstream>

#include "base/errors.h"
#include "base/files.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

/// Finds the last line, counted from 1 and at most `last`, that is indented by a tab; 0 if there is none.
int line_indented_by_tab(const std::string& text, int last) {
  std::istringstream lines(text);
  int line = 0, found = 0;
  for (std::string content; line < last && std::getline(lines, content);) {
    ++line;
    const std::size_t first = content.find_first_not_of(" \t\r");
    if (first == std::string::npos || content[first] == '#') continue;
    if (content.find('\t') < first) found = line;
  }
  return found;
}

}  // namespace

YamlFile::YamlFile(fs::path file) : file_(std::move(file)) {
  const std::string text = read_text(file_);
  try {
    root_ = only_document(text);
  } catch (const YAML::Exception& error) {
    // yaml-cpp reports a tab by one of a dozen messages, here or some lines further on.
    const int tab = line_indented_by_tab(text, error.mark.is_null() ? 1 << 30 : error.mark.line + 1);
    if (tab > 0)
      throw BadInput(fmt::format("{}:{}", file_.string(), tab), "a tab that indents", "blanks, which YAML indents with",
                     "put blanks in its place");
    throw BadInput(where(error.mark), error.msg, "YAML", "mend the line");
  }
}

/// Parses the only document of a text; yaml-cpp would ignore a second one.
YAML::Node YamlFile::only_document(const std::string& text) const {
  const std::vector<YAML::Node> documents = YAML::LoadAll(text);
  if (documents.empty()) return YAML::Load(text);
  for (std::size_t k = 1; k < documents.size(); ++k) {
    if (documents[k].IsNull()) continue;
    // The mark of a document is its first word; the document begins at the "---" before it.
    int line = 0, begin = 0;
    std::istringstream lines(text);
    for (std::string content; line <= documents[k].Mark().line && std::getline(lines, content);) {
      ++line;
      if (content.starts_with("---")) begin = line;
    }
    throw BadInput(fmt::format("{}:{}", file_.string(), begin), "a second document", "one document",
                   "put all into the first, or that into a file of its own");
  }
  return documents[0];
}

std::string YamlFile::where(const YAML::Mark& mark) const {
  return mark.is_null() ? file_.string() : fmt::format("{}:{}", file_.string(), mark.line + 1);
}

void YamlFile::require(bool good, const YAML::Node& node, const std::string& found, const std::string& expected) const {
  if (!good) throw BadInput(where(node), found, expected, "change the line");
}

void YamlFile::check_keys(const YAML::Node& map, const std::vector<std::string>& known) const {
  require(map.IsMap(), map, map.IsScalar() ? "'" + map.Scalar() + "'" : "not a mapping",
          known.empty() ? "a mapping" : fmt::format("a mapping of {}", fmt::join(known, ", ")));
  std::set<std::string> seen;
  for (const auto& entry : map) {
    require(entry.first.IsScalar(), entry.first, "a key that is not a word", "a word");
    const std::string& key = entry.first.Scalar();
    require(known.empty() || std::find(known.begin(), known.end(), key) != known.end(), entry.first,
            fmt::format("unknown key '{}'", key), fmt::format("one of {}", fmt::join(known, ", ")));
    require(seen.insert(key).second, entry.first, fmt::format("key '{}' a second time", key), "each key once");
  }
}

std::string YamlFile::scalar(const YAML::Node& node, const std::string& expected) const {
  require(node.IsScalar() && !node.Scalar().empty(), node,
          node.IsScalar() || node.IsNull() ? "nothing" : "more than one value", expected);
  return node.Scalar();
}

std::string YamlFile::number(const YAML::Node& node) const {
  if (!node.IsDefined()) return "";
  const std::string text = scalar(node, "a number");
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  require(error == std::errc() && end == text.data() + text.size() && std::isfinite(value), node, "'" + text + "'",
          "a number");
  return text;
}

fs::path YamlFile::path(const YAML::Node& node) const {
  const std::string text = scalar(node, "a path");
  require(text.find('\0') == std::string::npos, node, "a NUL in a path", "a path without one");
  return text;
}

}  // namespace kiln
