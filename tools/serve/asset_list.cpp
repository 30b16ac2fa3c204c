// SPDX-License-Identifier: GPL-3.0-or-later
#include "serve/asset_list.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <fmt/format.h>
#include <fstream>
#include <system_error>

#include "asset/format.h"
#include "base/asset_layout.h"
#include "base/errors.h"
#include "base/file_names.h"
#include "base/json.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr int most_levels_down = 3;

bool is_described(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / ranges_name, error) || fs::is_regular_file(folder / pca_name, error);
}

/// Tells whether a glTF file names the extension that relights it.
bool is_relightable_glb(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::array<char, 20> head{};
  if (!stream.read(head.data(), head.size()) || std::string_view(head.data(), 4) != "glTF") return false;
  std::uint32_t length = 0;
  for (int k = 0; k < 4; ++k)
    length |= static_cast<std::uint32_t>(static_cast<unsigned char>(head.at(12 + k))) << 8 * k;
  std::error_code error;
  if (length > fs::file_size(file, error)) return false;
  std::string json(length, '\0');
  return stream.read(json.data(), length) && json.find("\"KILN_prt\"") != std::string::npos;
}

std::string name_of(const fs::path& root, const fs::path& relative) {
  fs::path shown = relative;
  if (shown.filename() == layout::baked_folder) shown = shown.parent_path();
  if (!shown.empty() && shown != ".") return shown.generic_string();
  // The folder itself is the asset: its own name, or its parent's where it is called prt.
  std::error_code error;
  fs::path whole = fs::weakly_canonical(root / relative, error);
  if (whole.filename() == layout::baked_folder) whole = whole.parent_path();
  return text_of_path(whole.filename());
}

void search(const fs::path& root, const fs::path& relative, const fs::path& but_not, int levels_left,
            std::vector<ListedAsset>& found) {
  const fs::path folder = relative.empty() ? root : root / relative;
  if (is_described(folder)) {
    const fs::path path = relative.empty() ? fs::path(".") : relative;
    found.push_back({name_of(root, path), path.generic_string()});
    return;
  }
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const fs::path name = entry.path().filename();
    if (name.string().starts_with('.') || !is_utf8(name.string())) continue;
    if (entry.is_directory(error) && !entry.is_symlink(error)) {
      if (levels_left > 0 && !(!but_not.empty() && fs::equivalent(entry.path(), but_not, error)))
        search(root, relative / name, but_not, levels_left - 1, found);
    } else if (name.extension() == ".glb" && entry.is_regular_file(error) && is_relightable_glb(entry.path())) {
      const std::string path = (relative / name).generic_string();
      found.push_back({path, path});
    }
  }
}

}  // namespace

std::vector<ListedAsset> list_assets(const fs::path& folder, const fs::path& but_not) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw BadInput(folder.string(), fs::exists(folder, error) ? "is no folder" : "does not exist", "a folder of assets",
                   "name the output folder of kiln build, or of kiln-bake");
  std::vector<ListedAsset> found;
  search(folder, "", but_not, most_levels_down, found);
  std::ranges::sort(found, {}, &ListedAsset::path);
  return found;
}

std::string url_of_path(const std::string& path) {
  std::string url;
  for (const char letter : path) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(letter)) != 0 ||
                          std::string_view("-._~/").find(letter) != std::string_view::npos;
    url += is_plain ? std::string(1, letter) : fmt::format("%{:02X}", static_cast<unsigned char>(letter));
  }
  return url;
}

std::string path_of_url(std::string_view url) {
  std::string path;
  for (std::size_t k = 0; k < url.size(); ++k) {
    unsigned char byte = 0;
    const std::string_view digits = url.substr(k + 1, 2);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
    const bool is_escape = url[k] == '%' && digits.size() == 2 && error == std::errc() && end == digits.data() + 2;
    path += is_escape ? static_cast<char>(byte) : url[k];
    if (is_escape) k += 2;
  }
  return path;
}

std::string asset_list_text(const std::vector<ListedAsset>& assets) {
  Json list = Json::array();
  for (const ListedAsset& asset : assets) list.push_back({{"name", asset.name}, {"path", url_of_path(asset.path)}});
  return json_text({{"assets", list}}, 2) + "\n";
}

}  // namespace kiln
