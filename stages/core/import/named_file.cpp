// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/named_file.h"

#include <algorithm>
#include <string>

#include "base/files.h"
#include "import/text_lines.h"

namespace kiln {

namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

std::string lower(std::string text) {
  for (char& c : text) c = in_lower_case(c);
  return text;
}

std::optional<fs::path> find_in_any_case(const fs::path& folder, const std::string& name) {
  std::error_code error;
  std::optional<fs::path> found;
  const std::string sought = lower(name);
  for (fs::directory_iterator entry(folder_of(folder / name), error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path file = entry->path().filename();
    if (lower(file.string()) == sought && is_file(folder / file) && (!found || folder / file < *found))
      found = folder / file;
  }
  return found;
}

}  // namespace

std::optional<fs::path> find_named_file(const fs::path& folder, std::string_view name) {
  if (name.empty() || name.find('\0') != std::string_view::npos) return std::nullopt;
  if (is_file(folder / name)) return folder / name;
  std::string slashes(name);
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  if (is_file(folder / slashes)) return folder / slashes;
  const std::string last = slashes.substr(slashes.rfind('/') + 1);
  if (last.empty() || last == "." || last == "..") return std::nullopt;
  if (is_file(folder / last)) return folder / last;
  return find_in_any_case(folder, last);
}

}  // namespace kiln
