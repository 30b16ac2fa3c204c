// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/asset_names.h"

#include <algorithm>
#include <fmt/format.h>
#include <glob.h>

#include "base/file_names.h"
#include "kiln/gate/comparison_page.h"
#include "kiln/gate/junit.h"
#include "kiln/gate/markdown.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_bytes = 200;
constexpr std::string_view refused = "/\\:*?\"<>|";

bool is_control(unsigned char c) { return c < 0x20 || c == 0x7f; }

/// Tests for C1 controls, U+2028 and U+2029, which end lines.
bool has_wide_control(const std::string& name) {
  for (std::size_t k = 0; k + 1 < name.size(); ++k) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(name[k + i]); };
    if (byte(0) == 0xc2 && byte(1) < 0xa0) return true;
    if (k + 2 < name.size() && byte(0) == 0xe2 && byte(1) == 0x80 && (byte(2) == 0xa8 || byte(2) == 0xa9)) return true;
  }
  return false;
}

/// Tests whether a name is taken by a file beside the assets' folders.
bool is_taken(const std::string& name) {
  for (const char* file :
       {"Makefile", "index.html", junit_file, summary_file, comparison_file, comparison_data_file, comparison_folder})
    if (name == file) return true;
  return false;
}

}  // namespace

std::string fault_of_name(const std::string& name) {
  if (name.empty()) return "is empty";
  if (name.size() > most_bytes) return fmt::format("has {} bytes, more than {}", name.size(), most_bytes);
  if (!is_utf8(name)) return "is not UTF-8";
  if (std::any_of(name.begin(), name.end(), is_control) || has_wide_control(name)) return "has a control character";
  if (const std::size_t at = name.find_first_of(refused); at != std::string::npos)
    return fmt::format("has a {}", name[at]);
  if (name.front() == '.' || name.front() == '-' || name.front() == ' ')
    return fmt::format("begins with '{}'", name.front());
  if (name.back() == '.' || name.back() == ' ') return fmt::format("ends with '{}'", name.back());
  if (name.ends_with(".yaml") || name.ends_with(".yml")) return "ends as a pipeline file does";
  if (is_taken(name)) return "is that of a file of the output folder";
  return "";
}

std::string name_of_mesh(const fs::path& mesh) {
  const std::string name = mesh.stem().string();
  std::string clean;
  for (std::size_t at = 0; at < name.size();) {
    const std::size_t count = std::max<std::size_t>(1, utf8_bytes_at(name, at));
    const std::string character = name.substr(at, count);
    const bool bad = !is_utf8(character) || is_control(character[0]) || has_wide_control(character) ||
                     refused.find(character[0]) != std::string_view::npos;
    clean += bad ? "_" : character;
    at += count;
  }
  if (clean.size() > most_bytes) {
    clean.resize(most_bytes);
    while (!is_utf8(clean)) clean.pop_back();
  }
  if (clean.empty() || clean.front() == '.' || clean.front() == '-' || clean.front() == ' ') clean.insert(0, "_");
  return fault_of_name(clean).empty() ? clean : clean + "_";
}

bool is_pattern(const std::string& text) { return text.find_first_of("*?[{") != std::string::npos; }

std::vector<fs::path> matching_files(const fs::path& folder, const std::string& pattern) {
  const fs::path whole = fs::path(pattern).is_absolute() || folder == "." ? fs::path(pattern) : fs::path();
  std::string escaped;  // characters of the folder that would be a pattern are escaped
  if (whole.empty()) {
    for (const char c : folder.string()) {
      if (std::string_view("\\*?[]{},~").find(c) != std::string_view::npos) escaped += '\\';
      escaped += c;
    }
    escaped += "/";
  }
  glob_t found = {};
  std::vector<fs::path> files;
  if (glob((escaped + pattern).c_str(), GLOB_BRACE, nullptr, &found) == 0)
    for (std::size_t k = 0; k < found.gl_pathc; ++k) {
      const fs::path file = found.gl_pathv[k];
      std::error_code error;
      if (fs::is_regular_file(file, error)) files.push_back(whole.empty() ? file.lexically_relative(folder) : file);
    }
  globfree(&found);
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

}  // namespace kiln
